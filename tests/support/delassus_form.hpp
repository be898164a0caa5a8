#pragma once
// Problems with a stored W, made from the dynamics form: for tests of what takes both.

#include "problems/algebra/delassus.hpp"

namespace ballast {

/// u = W r + q with three rows per contact, and nothing known of bodies.
inline FrictionProblem stored_problem(std::vector<double> friction, const Eigen::MatrixXd& w,
                                      const Eigen::VectorXd& q) {
  FrictionProblem problem;
  problem.has_delassus = true;
  for (std::size_t c = 1; c <= friction.size(); ++c)
    problem.row_begin.push_back(3 * static_cast<int>(c));
  problem.friction = std::move(friction);
  problem.delassus.w = w.sparseView();
  problem.delassus.q = q;
  return problem;
}

/// Adds the Delassus form to a problem that has only the dynamics form.
inline void add_delassus_form(FrictionProblem& problem) {
  if (problem.has_delassus) return;
  problem.delassus.w = delassus_matrix(problem);
  free_contact_velocity(problem, problem.delassus.q);
  problem.has_delassus = true;
}

/// The same problem in the Delassus form alone.
inline FrictionProblem only_delassus(FrictionProblem problem) {
  add_delassus_form(problem);
  problem.has_dynamics = false;
  return problem;
}

}  // namespace ballast
