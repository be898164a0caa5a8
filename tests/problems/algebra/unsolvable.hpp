#pragma once
// The smallest problems that no impulses solve.

#include "tests/support/delassus_form.hpp"

namespace ballast {

/// One contact with friction 0.5 and W = 0 between two bodies that never move, which part with
/// `normal_velocity` [m/s]: a negative one has no solution.
inline FrictionProblem immovable_contact(double normal_velocity) {
  return stored_problem({0.5}, Eigen::Matrix3d::Zero(), Eigen::Vector3d(normal_velocity, 0.0, 0.0));
}

/// W = [1 -1; -1 1] (x) I, q_N = -1, -1: a body of 1 kg between two walls that both close in with
/// 1 m/s. With any impulses u_N1 + u_N2 = -2 m/s.
inline FrictionProblem squeezed_contacts() {
  Eigen::MatrixXd w = Eigen::MatrixXd::Identity(6, 6);
  w.topRightCorner(3, 3) = w.bottomLeftCorner(3, 3) = -Eigen::Matrix3d::Identity();
  return stored_problem({0.5, 0.5}, w, -(Impulses::Unit(6, 0) + Impulses::Unit(6, 3)));
}

/// A cube of 1 kg at rest on a floor, with W = I at its one contact, and a step of gravity:
/// q_N = -g h. Its tangential velocity of 1 mm/s makes mu |u_T| hide u_N if mu is large.
inline FrictionProblem rough_contact(double mu) {
  return stored_problem({mu}, Eigen::Matrix3d::Identity(), Eigen::Vector3d(-9.81e-3, 1e-3, 0.0));
}

}  // namespace ballast
