#pragma once
// The convex cone program behind Coulomb's law, in units of its own, for general optimisers:
//
//   min 1/2 x.W x + x.(q + s n)   over x in K_mu
//
// and the s-update (slip_shift.hpp) around any solver of it.

#include <functional>
#include <vector>

#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/rounds.hpp"

namespace ballast {

/// The task of a solver of the convex program. Task and answer have no units: no block of W's
/// diagonal has an eigenvalue above one, and the largest entry of the problem's q is one.
struct ConeRequest {
  const Eigen::VectorXd& q;      ///< with s, one entry per row of ConeProgram
  const Eigen::VectorXd& start;  ///< in the cones
  double accuracy;  ///< natural map that the budget asks for, in the program's unit of velocity
  Budget left;
};

/// Contacts that no impulse moves are left out; contacts with mu = 0 keep one row.
class ConeProgram {
 public:
  /// `problem` must outlive the use of the program.
  void take(const FrictionProblem& problem);

  int contact_count() const { return static_cast<int>(friction.size()); }
  int row_count() const { return row_begin.back(); }
  bool has_friction(int k) const { return row_begin[k + 1] - row_begin[k] == 3; }

  std::vector<int> row_begin{0};  ///< 1 or 3 rows per contact, normal first
  std::vector<double> friction;   ///< mu; > 0 where there are three rows
  SparseRows w;                   ///< symmetric part
  Eigen::VectorXd q;              ///< without s

  /// Moves every contact to the nearest point of its cone or half-line.
  void project(Eigen::VectorXd& x) const;

  /// Calls `convex` in rounds, with the s-update between them. `convex` sets answer.x (rows of
  /// ConeProgram), iterations and finished.
  Solved solve(Impulses start, const Budget& budget, int patience,
               const std::function<void(const ConeRequest&, RoundAnswer&)>& convex);

 private:
  ReducedProblem moving_;
  SparseRows w_as_is_;  ///< a stored W may be unsymmetric: solve() adds its skew part to q, like s
  std::vector<int> row_;   ///< row in ReducedProblem of each row here
  Eigen::VectorXd scale_;  ///< per row: impulse = scale * x [N s]
  double unit_ = 1.0;      ///< largest |entry| of q / sqrt(lambda_max(W_cc)) [sqrt(J)]
  double velocity_unit_ = 1.0;
  ContactOperator operator_;
  SlipShift shift_;
};

}  // namespace ballast
