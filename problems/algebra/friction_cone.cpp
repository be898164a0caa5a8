#include "problems/algebra/friction_cone.hpp"

namespace ballast {

Eigen::Vector3d project_dual_cone(const Eigen::Vector3d& x, double mu) {
  // Inside K* = {u : u_N >= mu |u_T|}, inside its polar cone -K_mu, or else nearest to K*'s side.
  const double t = tangential_norm(x);
  if (x[0] >= mu * t) return x;
  if (t <= -mu * x[0]) return Eigen::Vector3d::Zero();  // -x in K_mu
  // On the side u_N = mu |u_T|: written out, since x + P_K(-x) would cancel.
  const double length = (t + mu * x[0]) / (1.0 + mu * mu);
  const double scale = t > 0.0 ? length / t : 0.0;
  return {mu * length, scale * x[1], scale * x[2]};
}

Eigen::Matrix3d project_cone_jacobian(const Eigen::Vector3d& x, double mu) {
  // Of x = (x_N, x_T), by its normal part and the length of its tangential one:
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

}  // namespace ballast
