#include "solvers/parts/regular_contact.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {

RegularStep regular_step(double mu, double rho, double epsilon, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u) {
  RegularStep step;
  const double stiffness = rho / epsilon;
  const Eigen::Vector3d z = r - rho * u;
  // Open: the impulse goes to zero.
  if (z[0] <= 0.0) {
    step.source = -r;
    return step;
  }
  if (mu == 0.0) {  // a half-line
    step.source = Eigen::Vector3d(-u[0] * stiffness, -r[1], -r[2]);
    step.gain(0, 0) = stiffness;
    step.status = ContactStatus::stick;
    return step;
  }
  // Stick: u~ + du~ = 0.
  // u~ changes by du + epsilon_c dr, hence dr = -(u~ + du) / epsilon_c: a stiff spring.
  const double t = std::hypot(z[1], z[2]);
  if (t <= mu * z[0]) {
    step.source = -u * stiffness;
    step.gain = stiffness * Eigen::Matrix3d::Identity();
    step.status = ContactStatus::stick;
    return step;
  }
  // Slip: u~_N + du~_N = 0. Along z_T the impulse goes to the disc's edge, which moves with r_N;
  // across z_T it turns as the projection on the disc does. kappa <= 1: else a gain is negative.
  const double e1 = z[1] / t, e2 = z[2] / t, radius = mu * std::max(r[0], 0.0);
  const double kappa = std::min(1.0, radius / t);
  // Across z_T: r + dr = kappa dz with dz = dr - rho (du + epsilon_c dr) and rho epsilon_c =
  // epsilon give (1 - kappa + kappa epsilon) dr = -r - kappa rho du.
  const double turn = 1.0 - kappa + kappa * epsilon, across_gain = kappa * rho / turn;
  const double normal = -u[0] * stiffness;
  const double along = radius - (e1 * r[1] + e2 * r[2]) + mu * normal;
  const double across = -(e1 * r[2] - e2 * r[1]) / turn;
  step.source = Eigen::Vector3d(normal, along * e1 - across * e2, along * e2 + across * e1);
  step.gain << stiffness, 0.0, 0.0,                                        //
      mu * e1 * stiffness, across_gain * e2 * e2, -across_gain * e1 * e2,  //
      mu * e2 * stiffness, -across_gain * e1 * e2, across_gain * e1 * e1;
  step.status = ContactStatus::slip;
  return step;
}

}  // namespace ballast
