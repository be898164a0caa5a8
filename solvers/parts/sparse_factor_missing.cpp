// Compiled in place of sparse_factor.cpp where SuiteSparse is not used.

#include "solvers/parts/sparse_factor.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {
namespace {

[[noreturn]] void decline() {
  throw UnsupportedProblem("built without SuiteSparse: there are no sparse factors");
}

}  // namespace

bool has_sparse_factors() { return false; }

LuFactor::LuFactor() : state_(nullptr, nullptr) {}
bool LuFactor::factor(const SparseColumns&) { decline(); }
void LuFactor::solve(const Eigen::VectorXd&, Eigen::VectorXd&) { decline(); }

std::vector<int> dissection_order(const BlockGraph&) { decline(); }

}  // namespace ballast
