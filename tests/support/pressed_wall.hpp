#pragma once
// The smallest jam: a wall with one unknown, pressed against a stop.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// A wall of 2 kg that would move at 1 m/s into a stop: 2 N s hold it.
inline FrictionProblem pressed_wall() {
  FrictionProblem problem;
  problem.has_dynamics = true;
  problem.row_begin = {0, 1};
  problem.friction = {0.0};
  problem.dynamics.dof_begin = {0, 1};
  problem.dynamics.mass_begin = {0, 1};
  problem.dynamics.mass = {2.0};
  problem.dynamics.body_a = {-1};
  problem.dynamics.body_b = {0};
  problem.dynamics.h_begin = {0, 1};
  problem.dynamics.h = {1.0};
  problem.dynamics.v_free = Eigen::VectorXd::Constant(1, -1.0);
  problem.dynamics.bias = Eigen::VectorXd::Zero(1);
  return problem;
}

}  // namespace ballast
