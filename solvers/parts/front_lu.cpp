#include "solvers/parts/front_lu.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "platform/for_each_cpu.hpp"
#include "solvers/parts/dense_kernels.hpp"

namespace ballast {
namespace {

/// Solves L y = y in place on a front's own rows, and adds L_below y to `below` for its boundary.
BALLAST_FOR_EACH_CPU
void forward(const double* a, int rows, int own, double* __restrict y, double* __restrict below) {
  for (int j = 0; j < own; ++j, a += rows) {
    const double factor = y[j];
    for (int i = j + 1; i < own; ++i) y[i] -= a[i] * factor;
    for (int i = own; i < rows; ++i) below[i - own] += a[i] * factor;
  }
}

/// Solves U y = y - (rest of the own rows) times the boundary's values, in place.
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
  if (pattern_.is(a) && unknown_begin_ == unknown_begin) return;
  const BlockGraph graph = block_graph(unknown_begin, a.outerIndexPtr(), a.innerIndexPtr());
  tree_ = make_front_tree(graph, dissection_order(graph));
  numbers_.resize(tree_.numbers);
  boundaries_.resize(tree_.boundaries);
  for (Eigen::VectorXd* x : {&work_, &below_, &largest_}) x->resize(a.rows());
  list_runs();
  place_entries(a);
  pattern_.take(a);
  unknown_begin_ = unknown_begin;
}

/// Rows come in blocks, and neighbours often stay neighbours in the parent: runs are long.
void FrontLu::list_runs() {
  runs_.clear();
  runs_begin_.assign(1, 0);
  for (const Front& child : tree_.fronts) {
    const int* row = tree_.row_in_parent.data() + child.rows_begin + child.own;
    const int own = child.parent < 0 ? 0 : tree_.fronts[child.parent].own;
    for (int i = 0; i < child.boundary(); ++i)
      if (i == 0 || row[i] != row[i - 1] + 1 || row[i] == own)
        runs_.push_back({i, row[i], 1});
      else
        ++runs_.back().count;
    runs_begin_.push_back(static_cast<int>(runs_.size()));
  }
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
  // Sorts the entries by front, then looks up the rows of one front after the other.
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
  for (int j = 0; j < a.cols(); ++j) {
    double largest = 0.0;
    for (int e = a.outerIndexPtr()[j]; e < a.outerIndexPtr()[j + 1]; ++e)
      largest = std::max(largest, std::abs(a.valuePtr()[e]));
    largest_[tree_.place[j]] = largest;
  }
  const int branches = static_cast<int>(tree_.branches.size());
  std::atomic<bool> breaks_down{false};
  run_parts(team_, branches, [&](int branch) {
    const auto& [first, end] = tree_.branches[branch];
    for (int f = first; f < end; ++f)
      if (!factor_front(f, a.valuePtr(), false)) {
        breaks_down = true;
        return;
      }
  });
  if (breaks_down) return false;
  for (const int f : tree_.trunk)
    if (!factor_front(f, a.valuePtr(), true)) return false;
  return true;
}

/// `shares`: the team shares the columns of this front.
bool FrontLu::factor_front(int number, const double* values, bool shares) {
  const Front& front = tree_.fronts[number];
  double *numbers = numbers_.data() + front.numbers_at,
         *boundary = boundaries_.data() + front.boundary_made_at;
  const std::int64_t own = front.own, outside = front.boundary();
  std::fill_n(numbers, own * (front.rows + outside), 0.0);
  std::fill_n(boundary, outside * outside, 0.0);
  // Adds the matrix's own entries, then the boundaries of the children, the last child first.
  for (int e = entries_begin_[number]; e < entries_begin_[number + 1]; ++e)
    numbers[entries_[e].to] += values[entries_[e].from];
  for (int k = 0, child = number - 1; k < front.child_count; ++k, --child) {
    while (tree_.fronts[child].parent != number) --child;
    extend_add(child, front, boundary);
  }
  if (!eliminate(front, boundary, shares)) return false;
  std::copy_n(boundary, outside * outside, boundaries_.data() + front.boundary_kept_at);
  return true;
}

/// Adds a child's boundary to its parent. The child's rows ascend: first the parent's own rows,
/// then rows of its boundary; so do its columns. That makes four blocks, in three places.
void FrontLu::extend_add(int child, const Front& front, double* boundary) {
  const int own = front.own, rows = tree_.fronts[child].boundary();
  const double* from = boundaries_.data() + tree_.fronts[child].boundary_kept_at;
  double* columns = numbers_.data() + front.numbers_at;
  double* rest = columns + static_cast<std::int64_t>(front.rows) * own;
  const Run *first = runs_.data() + runs_begin_[child],
            *end = runs_.data() + runs_begin_[child + 1];
  const Run* split = std::find_if(first, end, [own](const Run& run) { return run.to >= own; });
  const auto add = [&from](const Run* run, const Run* last, double* to) {
    for (; run < last; ++run)
      for (int i = 0; i < run->count; ++i) to[run->to + i] += from[run->from + i];
  };
  for (const Run* run = first; run < end; ++run)
    for (int column = run->to; column < run->to + run->count; ++column, from += rows) {
      if (column < own) {
        add(first, end, columns + static_cast<std::int64_t>(column) * front.rows);
        continue;
      }
      add(first, split, rest + static_cast<std::int64_t>(column - own) * own);
      add(split, end, boundary + static_cast<std::int64_t>(column - own) * front.boundary() - own);
    }
}

/// Eliminates one front, whose rows and columns are its own unknowns and then its boundary:
///
///     [ A11  A12 ]   [ L11     ] [ U11  U12 ]
///     [ A21  A22 ] = [ L21   1 ] [        S ]    S = A22 - L21 U12: the parent's share
///
/// `a` holds A11 and A21, `rest` A12 and `boundary` A22. A22 comes from the children alone, as the
/// matrix's own entries there belong to fronts above.
bool FrontLu::eliminate(const Front& front, double* boundary, bool shares) {
  constexpr int strip = 48, most_columns = 96;
  constexpr double smallest_pivot = 1e-14;
  const int rows = front.rows, own = front.own, outside = front.boundary();
  double* a = numbers_.data() + front.numbers_at;
  double* rest = a + static_cast<std::int64_t>(rows) * own;
  // Shared columns come in the same pieces, whatever the number of threads.
  const auto by_columns = [&](int columns, const auto& task) {
    if (!shares) return task(0, columns);
    run_ranges(team_, columns, most_columns, task);
  };
  const int most = shares ? strip : own;
  for (int j = 0; j < own; j += most) {
    const int width = std::min(most, own - j), right = own - j - width, below = rows - j - width;
    double* diagonal = a + static_cast<std::int64_t>(j) * rows + j;
    factor_columns(diagonal, rows, rows - j, width);
    double* beside = diagonal + static_cast<std::int64_t>(width) * rows;
    by_columns(right, [&](int first, int end) {
      const int count = end - first;
      double* at = beside + static_cast<std::int64_t>(first) * rows;
      solve_unit_lower(width, count, diagonal, rows, at, rows);
      subtract_product(below, count, width, diagonal + width, rows, at, rows, at + width, rows);
    });
  }
  // Rows are not exchanged, so that a tiny pivot would drown the following rows in rounding.
  for (int j = 0; j < own; ++j) {
    const double pivot = std::abs(a[static_cast<std::int64_t>(j) * rows + j]);
    if (!std::isfinite(pivot) || !(pivot > smallest_pivot * largest_[front.first + j]))
      return false;
  }
  if (outside == 0) return true;
  by_columns(outside, [&](int first, int end) {
    const int count = end - first;
    double* at = rest + static_cast<std::int64_t>(first) * own;
    solve_unit_lower(own, count, a, rows, at, own);
    subtract_product(outside, count, own, a + own, rows, at, own,
                     boundary + static_cast<std::int64_t>(first) * outside, outside);
  });
  return true;
}

void FrontLu::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  const int unknowns = static_cast<int>(work_.size()),
            fronts = static_cast<int>(tree_.fronts.size());
  for (int i = 0; i < unknowns; ++i) work_[tree_.place[i]] = b[i];
  // L y = b from the leaves up: a front solves its own rows, and subtracts their share from the
  // rows of its boundary, which belong to fronts above.
  for (int f = 0; f < fronts; ++f) {
    const Front& front = tree_.fronts[f];
    const int* place = tree_.places.data() + front.rows_begin + front.own;
    std::fill_n(below_.data(), front.boundary(), 0.0);
    forward(numbers_.data() + front.numbers_at, front.rows, front.own, work_.data() + front.first,
            below_.data());
    for (int i = 0; i < front.boundary(); ++i) work_[place[i]] -= below_[i];
  }
  // U x = y from the roots down: a front's boundary is known when its turn comes.
  for (int f = fronts - 1; f >= 0; --f) {
    const Front& front = tree_.fronts[f];
    const int* place = tree_.places.data() + front.rows_begin + front.own;
    for (int i = 0; i < front.boundary(); ++i) below_[i] = work_[place[i]];
    backward(numbers_.data() + front.numbers_at, front.rows, front.own, below_.data(),
             work_.data() + front.first);
  }
  x.resize(unknowns);
  for (int i = 0; i < unknowns; ++i) x[i] = work_[tree_.place[i]];
}

}  // namespace ballast
