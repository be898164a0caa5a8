#include "solvers/parts/sparse_factor.hpp"

#include <numeric>
#include <vector>

#include <cholmod.h>
#include <umfpack.h>

namespace ballast {

bool has_sparse_factors() { return true; }

struct LuFactor::State {
  void *symbolic = nullptr, *numeric = nullptr;
  double control[UMFPACK_CONTROL], info[UMFPACK_INFO];
  std::vector<int> index_work;
  std::vector<double> work;
  SparsePattern pattern;

  State() {
    umfpack_di_defaults(control);
    // Rows and columns are exchanged alike, and the diagonal's entry is the pivot where it is at
    // least a thousandth of the largest in its column.
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
    control[UMFPACK_SYM_PIVOT_TOLERANCE] = 1e-3;
    control[UMFPACK_SCALE] = UMFPACK_SCALE_NONE;
  }
  ~State() {
    umfpack_di_free_numeric(&numeric);
    umfpack_di_free_symbolic(&symbolic);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

LuFactor::LuFactor() : state_(new State, [](State* state) { delete state; }) {}

bool LuFactor::factor(const SparseColumns& a) {
  State& s = *state_;
  const int n = static_cast<int>(a.rows());
  umfpack_di_free_numeric(&s.numeric);
  if (!s.symbolic || !s.pattern.is(a)) {
    umfpack_di_free_symbolic(&s.symbolic);
    if (umfpack_di_symbolic(n, n, a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), &s.symbolic,
                            s.control, s.info) != UMFPACK_OK)
      return false;
    s.pattern.take(a);
    s.index_work.resize(static_cast<size_t>(n));
    s.work.resize(5 * static_cast<size_t>(n));
  }
  return umfpack_di_numeric(a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), s.symbolic,
                            &s.numeric, s.control, s.info) == UMFPACK_OK;
}

void LuFactor::solve(const SparseColumns& a, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                     int refinements) {
  State& s = *state_;
  x.resize(b.size());
  s.control[UMFPACK_IRSTEP] = refinements;
  umfpack_di_wsolve(UMFPACK_A, a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr(), x.data(),
                    b.data(), s.numeric, s.control, s.info, s.index_work.data(), s.work.data());
}

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
  if (!cholmod_metis(&view, nullptr, 0, 1, order.data(), &common))
    std::iota(order.begin(), order.end(), 0);
  cholmod_finish(&common);
  return order;
}

}  // namespace ballast
