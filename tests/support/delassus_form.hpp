#pragma once
// Problems with a stored W, made from the dynamics form, for tests of code that takes both forms.

#include "problems/algebra/delassus.hpp"

namespace ballast {

/// u = W r + q with three rows per contact, without bodies.
inline FrictionProblem stored_problem(std::vector<double> friction, const Eigen::MatrixXd& w,
                                      const Eigen::VectorXd& q) {
  return local_problem(w.sparseView(), q, std::move(friction));
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
