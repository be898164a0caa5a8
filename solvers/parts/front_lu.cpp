#include "solvers/parts/front_lu.hpp"

#include <algorithm>
#include <cmath>

#include "platform/for_each_cpu.hpp"

// BLAS under its Fortran names, which every BLAS has.
extern "C" {
void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n,
            const int* k, const double* alpha, const double* a, const int* stride_a,
            const double* b, const int* stride_b, const double* beta, double* c,
            const int* stride_c);
void dtrsm_(const char* side, const char* triangle, const char* transpose, const char* diagonal,
            const int* m, const int* n, const double* alpha, const double* a, const int* stride_a,
            double* b, const int* stride_b);
}

namespace ballast {
namespace {

/// C -= A B: A is m x k, B k x n, column-major with strides.
void subtract_product(int m, int n, int k, const double* a, int stride_a, const double* b,
                      int stride_b, double* c, int stride_c) {
  const double minus_one = -1.0, one = 1.0;
  dgemm_("N", "N", &m, &n, &k, &minus_one, a, &stride_a, b, &stride_b, &one, c, &stride_c);
}

/// B := L^-1 B: L unit lower triangular, m x m; B is m x n.
void solve_unit_lower(int m, int n, const double* l, int stride_l, double* b, int stride_b) {
  const double one = 1.0;
  dtrsm_("L", "L", "N", "U", &m, &n, &one, l, &stride_l, b, &stride_b);
}

/// A tall strip of `columns` columns, factored in place from its first row on.
BALLAST_FOR_EACH_CPU
void factor_strip(double* a, int stride, int rows, int columns) {
  // Column by column: what is below the pivot becomes a column of L, and its product with the
  // pivot's row is taken from the rest of the strip.
  for (int k = 0; k < columns; ++k) {
    double* __restrict pivot_column = a + static_cast<std::int64_t>(k) * stride;
    const double inverse = 1.0 / pivot_column[k];
    for (int i = k + 1; i < rows; ++i) pivot_column[i] *= inverse;
    for (int j = k + 1; j < columns; ++j) {
      double* __restrict column = a + static_cast<std::int64_t>(j) * stride;
      const double factor = column[k];
      for (int i = k + 1; i < rows; ++i) column[i] -= pivot_column[i] * factor;
    }
  }
}

/// L y = y on a front's own rows, and what they take from the boundary: `below` += L_below y.
BALLAST_FOR_EACH_CPU
void forward(const double* a, int rows, int own, double* __restrict y, double* __restrict below) {
  for (int j = 0; j < own; ++j, a += rows) {
    const double factor = y[j];
    for (int i = j + 1; i < own; ++i) y[i] -= a[i] * factor;
    for (int i = own; i < rows; ++i) below[i - own] += a[i] * factor;
  }
}

/// U y = y - (rest of the own rows) times the boundary's values.
BALLAST_FOR_EACH_CPU
void backward(const double* a, int rows, int own, const double* __restrict boundary,
              double* __restrict y) {
  const double* rest = a + static_cast<std::int64_t>(rows) * own;
  for (int j = 0; j < rows - own; ++j, rest += own) {
    const double factor = boundary[j];
    for (int i = 0; i < own; ++i) y[i] -= rest[i] * factor;
  }
  for (int j = own - 1; j >= 0; --j) {
    const double* column = a + static_cast<std::int64_t>(j) * rows;
    y[j] /= column[j];
    const double factor = y[j];
    for (int i = 0; i < j; ++i) y[i] -= column[i] * factor;
  }
}

}  // namespace

void FrontLu::analyse(const SparseColumns& a, const std::vector<int>& unknown_begin) {
  if (pattern_.is(a) && graph_.unknown_begin == unknown_begin) return;
  BlockGraph graph = block_graph(unknown_begin, a.outerIndexPtr(), a.innerIndexPtr());
  if (tree_.fronts.empty() || !(graph == graph_)) {
    tree_ = make_front_tree(graph, dissection_order(graph));
    graph_ = std::move(graph);
    layout();
  }
  place_entries(a);
  pattern_.take(a);
}

/// How many numbers each front needs, and how high the stack of boundaries grows.
void FrontLu::layout() {
  numbers_begin_.assign(1, 0);
  std::vector<std::int64_t> waiting;  // sizes of the boundaries on the stack
  std::int64_t height = 0, highest = 0;
  for (const Front& front : tree_.fronts) {
    const std::int64_t rows = front.rows, own = front.own, boundary = front.boundary();
    numbers_begin_.push_back(numbers_begin_.back() + rows * own + own * boundary);
    // A front's own boundary is made above those of its children, and then takes their place.
    highest = std::max(highest, height + boundary * boundary);
    for (int k = 0; k < front.child_count; ++k, waiting.pop_back()) height -= waiting.back();
    if (front.parent < 0) continue;
    waiting.push_back(boundary * boundary);
    height += waiting.back();
  }
  numbers_.resize(numbers_begin_.back());
  stack_.resize(highest);
  work_.resize(graph_.unknown_count());
  below_.resize(graph_.unknown_count());
  largest_.resize(graph_.unknown_count());
}

/// Every entry belongs to the front that eliminates the first of its two unknowns.
void FrontLu::place_entries(const SparseColumns& a) {
  const int fronts = static_cast<int>(tree_.fronts.size());
  std::vector<int> front_of(tree_.place.size()), row_of(tree_.place.size());
  for (int f = 0; f < fronts; ++f)
    std::fill_n(front_of.begin() + tree_.fronts[f].first, tree_.fronts[f].own, f);
  const int* outer = a.outerIndexPtr();
  const int* inner = a.innerIndexPtr();
  const auto for_each_entry = [&](const auto& visit) {
    for (int j = 0; j < a.cols(); ++j)
      for (int e = outer[j]; e < outer[j + 1]; ++e) {
        const int row = tree_.place[inner[e]], column = tree_.place[j];
        visit(front_of[std::min(row, column)], e, row, column);
      }
  };
  // Sorted by front, then each front's rows looked up at once.
  struct Placed {
    int from, row, column;
  };
  std::vector<Placed> sorted(a.nonZeros());
  entries_begin_.assign(fronts + 1, 0);
  for_each_entry([&](int f, int, int, int) { ++entries_begin_[f + 1]; });
  for (int f = 0; f < fronts; ++f) entries_begin_[f + 1] += entries_begin_[f];
  std::vector<int> next(entries_begin_.begin(), entries_begin_.end() - 1);
  for_each_entry([&](int f, int e, int row, int column) { sorted[next[f]++] = {e, row, column}; });
  entries_.resize(sorted.size());
  for (int f = 0; f < fronts; ++f) {
    const Front& front = tree_.fronts[f];
    for (int i = 0; i < front.rows; ++i) row_of[tree_.places[front.rows_begin + i]] = i;
    for (int e = entries_begin_[f]; e < entries_begin_[f + 1]; ++e) {
      const int row = row_of[sorted[e].row], column = row_of[sorted[e].column];
      const int to = column < front.own
                         ? row + column * front.rows
                         : front.rows * front.own + row + (column - front.own) * front.own;
      entries_[e] = {sorted[e].from, to};
    }
  }
}

bool FrontLu::factor(const SparseColumns& a) {
  // What a pivot is compared with.
  for (int j = 0; j < a.cols(); ++j) {
    double largest = 0.0;
    for (int e = a.outerIndexPtr()[j]; e < a.outerIndexPtr()[j + 1]; ++e)
      largest = std::max(largest, std::abs(a.valuePtr()[e]));
    largest_[tree_.place[j]] = largest;
  }
  // A front's boundary is made above those of its children, and then moved down over them:
  //
  //     | .. | child 1 | child 2 | own |    ->    | .. | own |
  std::int64_t top = 0;  // of the stack of boundaries
  for (int f = 0; f < static_cast<int>(tree_.fronts.size()); ++f) {
    const Front& front = tree_.fronts[f];
    const std::int64_t size = static_cast<std::int64_t>(front.boundary()) * front.boundary();
    double* boundary = stack_.data() + top;
    // The matrix's own entries, then the children's boundaries from the top of the stack down.
    assemble(front, f, a.valuePtr(), boundary);
    for (int k = 0, child = f - 1; k < front.child_count; ++k) {
      while (tree_.fronts[child].parent != f) --child;
      const std::int64_t rows = tree_.fronts[child].boundary();
      top -= rows * rows;
      extend_add(tree_.fronts[child], stack_.data() + top, front, boundary);
      --child;
    }
    if (!eliminate(front, boundary)) return false;
    // The children's boundaries are used up, and this front's own takes their place.
    std::copy_n(boundary, size, stack_.data() + top);
    top += size;
  }
  return true;
}

void FrontLu::assemble(const Front& front, int number, const double* values, double* boundary) {
  double* numbers = numbers_.data() + numbers_begin_[number];
  std::fill_n(numbers, numbers_begin_[number + 1] - numbers_begin_[number], 0.0);
  std::fill_n(boundary, static_cast<std::int64_t>(front.boundary()) * front.boundary(), 0.0);
  for (int e = entries_begin_[number]; e < entries_begin_[number + 1]; ++e)
    numbers[entries_[e].to] += values[entries_[e].from];
}

void FrontLu::extend_add(const Front& child, const double* from, const Front& front,
                         double* boundary) {
  const int number = child.parent, own = front.own, rows = child.boundary();
  const int* row = tree_.row_in_parent.data() + child.rows_begin + child.own;
  double* columns = numbers_.data() + numbers_begin_[number];
  double* rest = columns + static_cast<std::int64_t>(front.rows) * own;
  // The child's rows, which ascend, are first rows of the parent's own unknowns, from `split` on
  // rows of its boundary; so are its columns. That makes four blocks, in three places.
  const int split = static_cast<int>(std::lower_bound(row, row + rows, own) - row);
  for (int j = 0; j < rows; ++j, from += rows) {
    if (j < split) {
      double* to = columns + static_cast<std::int64_t>(row[j]) * front.rows;
      for (int i = 0; i < rows; ++i) to[row[i]] += from[i];
      continue;
    }
    double* to = rest + static_cast<std::int64_t>(row[j] - own) * own;
    for (int i = 0; i < split; ++i) to[row[i]] += from[i];
    to = boundary + static_cast<std::int64_t>(row[j] - own) * front.boundary() - own;
    for (int i = split; i < rows; ++i) to[row[i]] += from[i];
  }
}

/// The elimination of one front, whose rows and columns are its own unknowns and then its boundary:
///
///     [ A11  A12 ]   [ L11     ] [ U11  U12 ]
///     [ A21  A22 ] = [ L21   1 ] [        S ]    S = A22 - L21 U12: the parent's share
///
/// A11 and A21 are `a`, A12 is `rest`. A22 is `boundary`: it holds what the children left, as the
/// matrix's own entries there belong to fronts above.
bool FrontLu::eliminate(const Front& front, double* boundary) {
  constexpr int strip = 24;
  constexpr double smallest_pivot = 1e-14;
  const int number = static_cast<int>(&front - tree_.fronts.data());
  const int rows = front.rows, own = front.own, outside = front.boundary();
  double* a = numbers_.data() + numbers_begin_[number];
  double* rest = a + static_cast<std::int64_t>(rows) * own;
  // The own columns strip by strip: narrow ones by our own loops, all that is right of them by
  // BLAS.
  for (int j = 0; j < own; j += strip) {
    const int width = std::min(strip, own - j), right = own - j - width, below = rows - j - width;
    double* diagonal = a + static_cast<std::int64_t>(j) * rows + j;
    factor_strip(diagonal, rows, rows - j, width);
    if (right == 0) continue;
    double* beside = diagonal + static_cast<std::int64_t>(width) * rows;
    solve_unit_lower(width, right, diagonal, rows, beside, rows);
    subtract_product(below, right, width, diagonal + width, rows, beside, rows, beside + width,
                     rows);
  }
  // Nothing is exchanged, so that a tiny pivot would drown what follows in rounding.
  for (int j = 0; j < own; ++j) {
    const double pivot = std::abs(a[static_cast<std::int64_t>(j) * rows + j]);
    if (!std::isfinite(pivot) || !(pivot > smallest_pivot * largest_[front.first + j]))
      return false;
  }
  if (outside == 0) return true;
  // The rest of the own rows, and what is left for the parent.
  solve_unit_lower(own, outside, a, rows, rest, own);
  subtract_product(outside, outside, own, a + own, rows, rest, own, boundary, outside);
  return true;
}

void FrontLu::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  const int unknowns = graph_.unknown_count(), fronts = static_cast<int>(tree_.fronts.size());
  for (int i = 0; i < unknowns; ++i) work_[tree_.place[i]] = b[i];
  // L y = b from the leaves up: a front solves its own rows, and takes their share from the rows of
  // its boundary, which belong to fronts above.
  for (int f = 0; f < fronts; ++f) {
    const Front& front = tree_.fronts[f];
    const int* place = tree_.places.data() + front.rows_begin + front.own;
    std::fill_n(below_.data(), front.boundary(), 0.0);
    forward(numbers_.data() + numbers_begin_[f], front.rows, front.own, work_.data() + front.first,
            below_.data());
    for (int i = 0; i < front.boundary(); ++i) work_[place[i]] -= below_[i];
  }
  // U x = y from the roots down: a front's boundary is known when its turn comes.
  for (int f = fronts - 1; f >= 0; --f) {
    const Front& front = tree_.fronts[f];
    const int* place = tree_.places.data() + front.rows_begin + front.own;
    for (int i = 0; i < front.boundary(); ++i) below_[i] = work_[place[i]];
    backward(numbers_.data() + numbers_begin_[f], front.rows, front.own, below_.data(),
             work_.data() + front.first);
  }
  x.resize(unknowns);
  for (int i = 0; i < unknowns; ++i) x[i] = work_[tree_.place[i]];
}

double FrontLu::operations() const {
  double sum = 0.0;
  for (const Front& front : tree_.fronts) {
    // 2/3 k^3 for L11 U11, k^2 m each for L21 and U12, 2 k m^2 for S,
    // with k own and m boundary rows.
    const double own = front.own, outside = front.boundary();
    sum += 2.0 / 3.0 * own * own * own + 2.0 * own * own * outside + 2.0 * own * outside * outside;
  }
  return sum;
}

}  // namespace ballast
