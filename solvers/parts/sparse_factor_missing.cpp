// Compiled in place of sparse_factor.cpp and front_lu.cpp where SuiteSparse is not used.

#include "solvers/parts/front_lu.hpp"
#include "solvers/parts/sparse_factor.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {
namespace {

[[noreturn]] void decline() {
  throw UnsupportedProblem("built without SuiteSparse: there are no sparse factors");
}

}  // namespace

bool has_sparse_factors() { return false; }

struct CholeskyFactor::State {};
CholeskyFactor::CholeskyFactor() = default;
CholeskyFactor::~CholeskyFactor() = default;
CholeskyFactor::CholeskyFactor(CholeskyFactor&&) noexcept = default;
CholeskyFactor& CholeskyFactor::operator=(CholeskyFactor&&) noexcept = default;
bool CholeskyFactor::factor(const SparseColumns&) { decline(); }
void CholeskyFactor::solve(const Eigen::VectorXd&, Eigen::VectorXd&) { decline(); }

struct LuFactor::State {};
LuFactor::LuFactor() = default;
LuFactor::~LuFactor() = default;
LuFactor::LuFactor(LuFactor&&) noexcept = default;
LuFactor& LuFactor::operator=(LuFactor&&) noexcept = default;
bool LuFactor::factor(const SparseColumns&) { decline(); }
void LuFactor::solve(const SparseColumns&, const Eigen::VectorXd&, Eigen::VectorXd&, int) {
  decline();
}

std::vector<int> dissection_order(const BlockGraph&) { decline(); }
void FrontLu::analyse(const SparseColumns&, const std::vector<int>&) { decline(); }
bool FrontLu::factor(const SparseColumns&) { decline(); }
void FrontLu::solve(const Eigen::VectorXd&, Eigen::VectorXd&) { decline(); }
double FrontLu::operations() const { decline(); }

}  // namespace ballast
