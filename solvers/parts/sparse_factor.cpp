#include "solvers/parts/sparse_factor.hpp"

#include <mutex>
#include <numeric>

#include <cholmod.h>
#include <Eigen/UmfPackSupport>

namespace ballast {

namespace {

/// METIS seeds and reads the process's one rand(): two orderings at once would mix their numbers.
std::mutex metis;

}  // namespace

bool has_sparse_factors() { return true; }

struct LuFactor::State {
  Eigen::UmfPackLU<SparseColumns> lu;
  SparsePattern pattern;
};

LuFactor::LuFactor() : state_(new State, [](State* state) { delete state; }) {
  // Rows and columns are exchanged alike, and the diagonal's entry is the pivot where it is at
  // least a thousandth of the largest in its column. Each solution is refined once.
  auto& control = state_->lu.umfpackControl();
  control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
  control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
  control[UMFPACK_SYM_PIVOT_TOLERANCE] = 1e-3;
  control[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
  control[UMFPACK_IRSTEP] = 1;
}

bool LuFactor::factor(const SparseColumns& a) {
  if (!state_->pattern.is(a)) {
    state_->pattern.take(a);
    {
      const std::lock_guard alone(metis);
      state_->lu.analyzePattern(a);
    }
    if (state_->lu.info() != Eigen::Success) {
      state_->pattern = {};
      return false;
    }
  }
  state_->lu.factorize(a);
  return state_->lu.info() == Eigen::Success;
}

void LuFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) { x = state_->lu.solve(b); }

std::vector<int> dissection_order(const BlockGraph& graph) {
  // The graph as the pattern of a symmetric matrix's lower triangle.
  const int nodes = graph.node_count();
  std::vector<int> outer{0}, inner, order(nodes);
  for (int k = 0; k < nodes; ++k) {
    for (int i = graph.begin[k]; i < graph.begin[k + 1]; ++i)
      if (graph.neighbour[i] > k) inner.push_back(graph.neighbour[i]);
    outer.push_back(static_cast<int>(inner.size()));
  }
  std::iota(order.begin(), order.end(), 0);
  if (inner.empty()) return order;
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<size_t>(nodes);
  view.nzmax = inner.size();
  view.p = outer.data();
  view.i = inner.data();
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_PATTERN;
  view.sorted = view.packed = 1;
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  const std::lock_guard alone(metis);
  if (!cholmod_metis(&view, nullptr, 0, 1, order.data(), &common))
    std::iota(order.begin(), order.end(), 0);
  cholmod_finish(&common);
  return order;
}

}  // namespace ballast
