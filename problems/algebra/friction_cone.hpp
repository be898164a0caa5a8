#pragma once
// Coulomb's cone K_mu = {r : |r_T| <= mu r_N} and its dual K_mu* = {u : u_N >= mu |u_T|}. Normal
// first.

#include <cmath>

#include <Eigen/Dense>

namespace ballast {

/// What a contact does, by Coulomb's law.
enum class ContactStatus { open, stick, slip };

/// |x_T|
inline double tangential_norm(const Eigen::Vector3d& x) {
  return std::sqrt(x[1] * x[1] + x[2] * x[2]);
}

/// Euclidean projection onto K_mu. mu = 0 gives the half-line r_N >= 0.
inline Eigen::Vector3d project_cone(const Eigen::Vector3d& x, double mu) {
  const double t = tangential_norm(x);
  if (mu * t <= -x[0]) return Eigen::Vector3d::Zero();  // in the polar cone
  if (t <= mu * x[0]) return x;
  const double n = (mu * t + x[0]) / (1.0 + mu * mu);
  const double scale = mu * n / t;
  return {n, scale * x[1], scale * x[2]};
}

/// Euclidean projection onto K_mu* (Moreau: x = P_K(x) - P_K*(-x)).
Eigen::Vector3d project_dual_cone(const Eigen::Vector3d& x, double mu);

/// An element of the generalised Jacobian of project_cone at x (exact wherever it is
/// differentiable).
Eigen::Matrix3d project_cone_jacobian(const Eigen::Vector3d& x, double mu);

/// u + mu |u_T| n: De Saxce's modified velocity, in K_mu* exactly when Coulomb's law holds with r.
inline Eigen::Vector3d modified_velocity(const Eigen::Vector3d& u, double mu) {
  return {u[0] + mu * tangential_norm(u), u[1], u[2]};
}

/// r - P_K(r - rho (u + mu |u_T| n)): zero exactly when (u, r) satisfies Signorini-Coulomb, for
/// every rho > 0 [kg].
inline Eigen::Vector3d natural_map(const Eigen::Vector3d& r, const Eigen::Vector3d& u, double mu,
                                   double rho) {
  return r - project_cone(r - rho * modified_velocity(u, mu), mu);
}

}  // namespace ballast
