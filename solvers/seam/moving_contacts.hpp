#pragma once
// The problem in impulses alone, without the contacts that no impulse moves: what foreign solvers
// are handed.

#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// u = w r + q over the contacts kept, in the problem's order. The others (W_cc = 0: both bodies
/// fixed) have any impulse for a solution; they get zero.
struct MovingContacts {
  std::vector<int> contact;       ///< number in the problem of each contact kept
  std::vector<int> row_begin{0};  ///< rows of contact k here; size kept + 1
  std::vector<double> friction;
  std::vector<double> lambda_max;  ///< of W_cc, > 0 [1/kg]
  SparseRows w;                    ///< as it is: a stored one may be unsymmetric
  Eigen::VectorXd q;

  void take(const FrictionProblem& problem);
  void gather(const FrictionProblem& problem, const Impulses& r, Eigen::VectorXd& x) const;
  /// Contacts that were not kept become zero.
  void scatter(const FrictionProblem& problem, const Eigen::VectorXd& x, Impulses& r) const;

  int contact_count() const { return static_cast<int>(contact.size()); }
  int row_count() const { return row_begin.back(); }
  int rows(int k) const { return row_begin[k + 1] - row_begin[k]; }
};

}  // namespace ballast
