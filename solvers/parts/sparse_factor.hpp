#pragma once
// Sparse factorisations by SuiteSparse: the only place that knows CHOLMOD and UMFPACK. Beside them
// stands our own, parts/front_lu, for matrices whose unknowns come in blocks.
//
// Both keep the symbolic analysis while the pattern stays the same, so that a sequence of matrices
// is ordered once.

#include <memory>

#include <Eigen/Dense>

#include "solvers/parts/sparse_pattern.hpp"

namespace ballast {

/// This build has SuiteSparse. Where it has not, sparse_factor_missing.cpp stands in: whatever
/// factorises still compiles and links, factor() throws UnsupportedProblem, and the list of solvers
/// offers none of it.
bool has_sparse_factors();

/// A = L L^T for symmetric positive definite A (CHOLMOD: best of AMD and METIS, supernodal).
class CholeskyFactor {
 public:
  CholeskyFactor();

  /// Reads the lower triangle of `a` (square, compressed). Analyses when the pattern is not the
  /// last one's. False: not positive definite to working precision; then solve() must not be
  /// called.
  bool factor(const SparseColumns& a);
  /// x = A^-1 b, b of the size of A. `x` may be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  struct State;
  std::unique_ptr<State, void (*)(State*)> state_;
};

/// P A Q = L U for a general square A (UMFPACK, symmetric strategy first: our matrices are nearly
/// symmetric).
class LuFactor {
 public:
  LuFactor();

  /// `a` square, compressed, sorted. False: singular to working precision.
  bool factor(const SparseColumns& a);
  /// x = A^-1 b with the matrix given to factor(), which must still live (`a`): UMFPACK refines
  /// with it when `refinements` > 0. `x` must not be `b`.
  void solve(const SparseColumns& a, const Eigen::VectorXd& b, Eigen::VectorXd& x,
             int refinements = 0);

 private:
  struct State;
  std::unique_ptr<State, void (*)(State*)> state_;
};

}  // namespace ballast
