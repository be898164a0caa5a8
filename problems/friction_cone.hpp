#pragma once
// Coulomb's cone K_mu = {r : |r_T| <= mu r_N} and its dual K_mu* = {u : u_N >= mu |u_T|}. Normal first.

#include <Eigen/Dense>

namespace ballast {

/// Euclidean projection onto K_mu. mu = 0 gives the half-line r_N >= 0.
Eigen::Vector3d project_cone(const Eigen::Vector3d& x, double mu);

/// Euclidean projection onto K_mu* (Moreau: x = P_K(x) - P_K*(-x)).
Eigen::Vector3d project_dual_cone(const Eigen::Vector3d& x, double mu);

/// An element of the generalised Jacobian of project_cone at x (exact wherever it is differentiable).
Eigen::Matrix3d project_cone_jacobian(const Eigen::Vector3d& x, double mu);

/// u + mu |u_T| n: De Saxce's modified velocity, in K_mu* exactly when Coulomb's law holds with r.
Eigen::Vector3d modified_velocity(const Eigen::Vector3d& u, double mu);

/// r - P_K(r - rho (u + mu |u_T| n)): zero exactly when (u, r) satisfies Signorini-Coulomb, for every rho > 0 [kg].
Eigen::Vector3d natural_map(const Eigen::Vector3d& r, const Eigen::Vector3d& u, double mu, double rho);

}  // namespace ballast
