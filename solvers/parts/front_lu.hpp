#pragma once
// Multifrontal LU without pivoting, for the matrices of Newton's steps on bodies: M + H^T K H.
//
// Their symmetric part is nearly always positive definite and large on the diagonal, so that rows
// need not be exchanged; BodyMatrix::solve() checks the residual. It is faster than a general LU
// because the analysis works on bodies, the fronts are dense (dense_kernels.hpp), and the pattern's
// symmetry halves the bookkeeping. The ordering needs SuiteSparse: without it analyse() throws
// UnsupportedProblem.

#include <vector>

#include <Eigen/Dense>

#include "platform/worker_team.hpp"
#include "solvers/parts/sparse_factor.hpp"

namespace ballast {

/// Factors A = L U in an order of elimination that it chooses.
class FrontLu {
 public:
  /// Orders and analyses. `a` is square and compressed, with any pattern; `unknown_begin[k]` is the
  /// first unknown of block k, from 0 to the size of `a`. Does nothing where the pattern is the
  /// last one's.
  void analyse(const SparseColumns& a, const std::vector<int>& unknown_begin);
  /// Factors `a`, which has the pattern of analyse(). False: a pivot is not finite, or below 1e-14
  /// of the largest entry of its column in `a`; solve() must then not be called.
  bool factor(const SparseColumns& a);
  /// Shares factor() out to `team`; null: to nobody. The bits do not depend on its size.
  void use_team(WorkerTeam* team) { team_ = team; }
  /// x = A^-1 b. `x` may be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  const FrontTree& tree() const { return tree_; }

 private:
  /// The index of an entry among the matrix's values, and its index among a front's numbers.
  struct Entry {
    int from, to;
  };
  /// `count` rows of a front's boundary, from its row `from` on, that follow each other in its
  /// parent too, from the parent's row `to` on. All of them or none are the parent's own rows.
  struct Run {
    int from, to, count;
  };
  void list_runs();
  void place_entries(const SparseColumns& a);
  bool factor_front(int number, const double* values, bool shares);
  void extend_add(int child, const Front& front, double* boundary);
  bool eliminate(const Front& front, double* boundary, bool shares);

  SparsePattern pattern_;
  std::vector<int> unknown_begin_;
  FrontTree tree_;
  std::vector<double> numbers_, boundaries_;  ///< laid out as in Front
  std::vector<Entry> entries_;                ///< by front
  std::vector<int> entries_begin_;            ///< fronts + 1
  std::vector<Run> runs_;                     ///< by front
  std::vector<int> runs_begin_;               ///< fronts + 1
  Eigen::VectorXd largest_;  ///< by place: the largest entry of the column in the matrix
  Eigen::VectorXd work_, below_;
  WorkerTeam* team_ = nullptr;
};

}  // namespace ballast
