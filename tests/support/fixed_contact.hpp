#pragma once
// Contacts between two things that never move: their W is zero.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Adds a contact between two things that do not move, at the end of a problem in the dynamics form
/// alone. `bias` [m/s]: its velocity, one entry without friction, three with friction 0.5.
inline void add_fixed_contact(FrictionProblem& problem, const Eigen::VectorXd& bias) {
  const Eigen::Index rows = bias.size();
  problem.add_contact(-1, -1, rows == 1 ? 0.0 : 0.5, {}, Eigen::MatrixXd(rows, 0));
  problem.dynamics.bias.conservativeResize(problem.row_count());
  problem.dynamics.bias.tail(rows) = bias;
}

/// The same, approaching at 1 m/s and sliding, which no impulse can change.
inline void add_fixed_contact(FrictionProblem& problem) {
  add_fixed_contact(problem, Eigen::Vector3d(-1.0, 0.5, 0.5));
}

}  // namespace ballast
