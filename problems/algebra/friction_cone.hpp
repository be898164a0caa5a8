#pragma once
// Coulomb's cone K_mu = {r : |r_T| <= mu r_N} and its dual K_mu* = {u : u_N >= mu |u_T|}, normal
// first; and the root mean square over contacts in which the judge and the solvers give errors.

#include <cmath>

#include <Eigen/Dense>

namespace ballast {

/// The status of a contact under Coulomb's law.
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
inline Eigen::Vector3d project_dual_cone(const Eigen::Vector3d& x, double mu) {
  // Inside K* = {u : u_N >= mu |u_T|}, inside its polar cone -K_mu, or else nearest to K*'s side.
  const double t = tangential_norm(x);
  if (x[0] >= mu * t) return x;
  if (t <= -mu * x[0]) return Eigen::Vector3d::Zero();  // -x in K_mu
  // On the side u_N = mu |u_T|: written out, since x + P_K(-x) would cancel.
  const double length = (t + mu * x[0]) / (1.0 + mu * mu);
  const double scale = t > 0.0 ? length / t : 0.0;
  return {mu * length, scale * x[1], scale * x[2]};
}

/// An element of the generalised Jacobian of project_cone at x (exact wherever it is
/// differentiable).
inline Eigen::Matrix3d project_cone_jacobian(const Eigen::Vector3d& x, double mu) {
  // Regions of x = (x_N, x_T), by its normal part and the length of its tangential one:
  //
  //     x_N
  //      | K  /        in K_mu, |x_T| <= mu x_N:              P(x) = x
  //      |   /         between:                               P(x) on the side of K_mu
  //      |  /          in its polar cone, mu |x_T| <= -x_N:   P(x) = 0
  //      | /
  //      |/_____ |x_T|
  //      |\           the polar cone's side is at
  //      | \          right angles to that of K_mu
  const double t = tangential_norm(x);
  if (mu * t <= -x[0]) return Eigen::Matrix3d::Zero();
  if (t <= mu * x[0]) return Eigen::Matrix3d::Identity();
  // In between P_K(x) = n g with the generator g = (1, mu e), e = x_T / |x_T| and n = x.g / g.g.
  // Moving x along g changes n; moving it around the axis turns e, by 1 / |x_T|.
  const double weight = 1.0 / (1.0 + mu * mu);
  const double n = weight * (mu * t + x[0]);
  const Eigen::Vector3d side(1.0, mu * x[1] / t, mu * x[2] / t);  // the cone's generator towards x
  const Eigen::Vector3d turn(0.0, -x[2] / t, x[1] / t);           // around the cone
  return weight * side * side.transpose() + (mu * n / t) * turn * turn.transpose();
}

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

/// Root of the mean square of the values added so far, in their unit; 0 before the first. The bits
/// depend on the order in which values are added.
class RootMeanSquare {
 public:
  void add(double value) { add_square(value * value); }
  /// Adds a value by its square [its unit squared].
  void add_square(double square) {
    sum_ += square;
    ++count_;
  }
  /// Adds all values of a part that was summed separately.
  void add(const RootMeanSquare& part) {
    sum_ += part.sum_;
    count_ += part.count_;
  }
  double value() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0.0; }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

}  // namespace ballast
