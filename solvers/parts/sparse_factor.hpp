#pragma once
// A sparse factorisation by SuiteSparse: the only place that uses UMFPACK, and CHOLMOD for its
// ordering. parts/front_lu is Ballast's own, for matrices whose unknowns come in blocks.

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Sparse>

#include "solvers/parts/front_tree.hpp"

namespace ballast {

using SparseColumns = Eigen::SparseMatrix<double, Eigen::ColMajor>;

/// Whether this build has SuiteSparse. Where it has not, sparse_factor_missing.cpp takes its place:
/// callers still compile and link, factor() throws UnsupportedProblem, and the list of solvers
/// offers none that factorises.
bool has_sparse_factors();

/// The pattern of the last sparse matrix: the symbolic work on it is kept while the next matrix has
/// the same pattern.
class SparsePattern {
 public:
  /// Whether `a`, which is compressed, has this pattern.
  bool is(const SparseColumns& a) const {
    return static_cast<Eigen::Index>(outer_.size()) == a.outerSize() + 1 &&
           static_cast<Eigen::Index>(inner_.size()) == a.nonZeros() &&
           std::equal(outer_.begin(), outer_.end(), a.outerIndexPtr()) &&
           std::equal(inner_.begin(), inner_.end(), a.innerIndexPtr());
  }
  void take(const SparseColumns& a) {
    outer_.assign(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1);
    inner_.assign(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  }

 private:
  std::vector<int> outer_, inner_;
};

/// P A Q = L U for a general square A (UMFPACK, symmetric strategy first: our matrices are nearly
/// symmetric).
class LuFactor {
 public:
  LuFactor();

  /// `a` square, compressed, sorted. False: singular to working precision.
  bool factor(const SparseColumns& a);
  /// x = A^-1 b, refined once by its residual: the matrix given to factor() must still exist. `x`
  /// must not be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x);

 private:
  struct State;
  std::unique_ptr<State, void (*)(State*)> state_;
};

/// An order of elimination with little fill: nested dissection of the graph by METIS, which depends
/// on the graph alone. For few nodes, or where the library settles for less, it may be another
/// order.
std::vector<int> dissection_order(const BlockGraph& graph);

}  // namespace ballast
