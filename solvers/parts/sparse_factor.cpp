#include "solvers/parts/sparse_factor.hpp"

#include <numeric>
#include <vector>

#include <cholmod.h>
#include <umfpack.h>

#include "solvers/parts/front_lu.hpp"

namespace ballast {

bool has_sparse_factors() { return true; }

namespace {

/// CHOLMOD's view of the lower triangle of a symmetric matrix in compressed columns: nothing is
/// copied. `x` null: the pattern alone.
cholmod_sparse lower_view(size_t rows, size_t entries, const int* outer, const int* inner,
                          const double* x) {
  cholmod_sparse view{};
  view.nrow = view.ncol = rows;
  view.nzmax = entries;
  view.p = const_cast<int*>(outer);
  view.i = const_cast<int*>(inner);
  view.x = const_cast<double*>(x);
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = x ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = 1;
  view.packed = 1;
  return view;
}

}  // namespace

struct CholeskyFactor::State {
  cholmod_common common;
  cholmod_factor* factor = nullptr;
  cholmod_dense *x = nullptr, *y = nullptr,
                *e = nullptr;  // kept: cholmod_solve2 then allocates nothing
  SparsePattern pattern;

  State() {
    cholmod_start(&common);
    common.print = 0;
    common.quick_return_if_not_posdef = 1;
    common.supernodal = CHOLMOD_AUTO;
    common.final_ll = 1;  // the simplicial L D L^T would take an indefinite matrix
  }
  ~State() {
    cholmod_free_factor(&factor, &common);
    cholmod_free_dense(&x, &common);
    cholmod_free_dense(&y, &common);
    cholmod_free_dense(&e, &common);
    cholmod_finish(&common);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

CholeskyFactor::CholeskyFactor() : state_(new State, [](State* state) { delete state; }) {}

// The ordering is kept while the pattern is the same; the numbers are new every time.
bool CholeskyFactor::factor(const SparseColumns& a) {
  State& s = *state_;
  cholmod_sparse view = lower_view(static_cast<size_t>(a.rows()), static_cast<size_t>(a.nonZeros()),
                                   a.outerIndexPtr(), a.innerIndexPtr(), a.valuePtr());
  if (!s.factor || !s.pattern.is(a)) {
    cholmod_free_factor(&s.factor, &s.common);
    s.factor = cholmod_analyze(&view, &s.common);
    if (!s.factor) return false;
    s.pattern.take(a);
  }
  cholmod_factorize(&view, s.factor, &s.common);
  // `minor` is the column at which a pivot was not positive: n where all were.
  return s.common.status == CHOLMOD_OK && s.factor->minor == s.factor->n;
}

void CholeskyFactor::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  State& s = *state_;
  // CHOLMOD's view of b: nothing is copied.
  cholmod_dense right{};
  right.nrow = right.nzmax = right.d = static_cast<size_t>(b.size());
  right.ncol = 1;
  right.x = const_cast<double*>(b.data());
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, s.factor, &right, nullptr, &s.x, nullptr, &s.y, &s.e, &s.common);
  x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(s.x->x), b.size());
}

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
  // As above: a symbolic analysis for each new pattern only.
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
  cholmod_sparse view =
      lower_view(static_cast<size_t>(nodes), inner.size(), outer.data(), inner.data(), nullptr);
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  if (!cholmod_metis(&view, nullptr, 0, 1, order.data(), &common))
    std::iota(order.begin(), order.end(), 0);
  cholmod_finish(&common);
  return order;
}

}  // namespace ballast
