#pragma once
// The smallest problems that no impulses solve.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// One contact with friction 0.5 between two bodies that nothing moves, W = 0, which part with
/// `normal_velocity` [m/s]: negative has no solution.
inline FrictionProblem immovable_contact(double normal_velocity) {
  FrictionProblem problem;
  problem.has_delassus = true;
  problem.row_begin = {0, 3};
  problem.friction = {0.5};
  problem.delassus.w.resize(3, 3);
  problem.delassus.q = Eigen::Vector3d(normal_velocity, 0.0, 0.0);
  return problem;
}

/// W = [1 -1; -1 1] (x) I, q_N = -1, -1: a body of 1 kg between two walls that both close in with
/// 1 m/s. Any impulses leave u_N1 + u_N2 = -2 m/s.
inline FrictionProblem squeezed_contacts() {
  FrictionProblem problem;
  problem.has_delassus = true;
  problem.row_begin = {0, 3, 6};
  problem.friction = {0.5, 0.5};
  Eigen::MatrixXd w = Eigen::MatrixXd::Identity(6, 6);
  w.topRightCorner(3, 3) = w.bottomLeftCorner(3, 3) = -Eigen::Matrix3d::Identity();
  problem.delassus.w = w.sparseView();
  problem.delassus.q = Eigen::VectorXd::Zero(6);
  problem.delassus.q[0] = problem.delassus.q[3] = -1.0;
  return problem;
}

/// A cube of 1 kg at rest on a floor, W = I at its one contact, and a step of gravity: q_N = -g h.
/// The tangential rest of 1 mm/s stands for what makes u_N drown in mu |u_T|.
inline FrictionProblem rough_contact(double mu) {
  FrictionProblem problem;
  problem.has_delassus = true;
  problem.row_begin = {0, 3};
  problem.friction = {mu};
  problem.delassus.w = Eigen::MatrixXd(Eigen::Matrix3d::Identity()).sparseView();
  problem.delassus.q = Eigen::Vector3d(-9.81e-3, 1e-3, 0.0);
  return problem;
}

}  // namespace ballast
