#pragma once
// The smallest jam: a wall with one unknown, pressed against a stop.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// A wall of 2 kg that would move at 1 m/s into a stop: 2 N s hold it.
inline FrictionProblem pressed_wall() {
  FrictionProblem problem;
  problem.has_dynamics = true;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Ones(1, 1);
  const int wall = problem.dynamics.add_body(2.0 * one);
  problem.add_contact(-1, wall, 0.0, {}, one);
  problem.dynamics.v_free = Eigen::VectorXd::Constant(1, -1.0);
  problem.dynamics.bias = Eigen::VectorXd::Zero(1);
  return problem;
}

}  // namespace ballast
