#include "solvers/parts/front_layout.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// Lays a stack of boundaries for these fronts, children before parents, from `base` on. Returns
/// where it ends.
template <typename Fronts>
std::int64_t stack_boundaries(const FrontTree& tree, const Fronts& numbers, std::int64_t base,
                              FrontLayout& layout) {
  const auto size = [&](int f) {
    const std::int64_t boundary = tree.fronts[f].boundary();
    return boundary * boundary;
  };
  std::vector<int> waiting;
  std::int64_t top = base, highest = base;
  for (const int f : numbers) {
    layout.boundary_made[f] = top;
    highest = std::max(highest, top + size(f));
    for (; !waiting.empty() && tree.fronts[waiting.back()].parent == f; waiting.pop_back())
      top -= size(waiting.back());
    layout.boundary_kept[f] = top;
    top += size(f);
    waiting.push_back(f);
  }
  return highest;
}

/// The heaviest subtrees are taken apart, their uppermost fronts into the trunk, until none is a
/// large part of the whole.
void share_out(const FrontTree& tree, FrontLayout& layout) {
  constexpr double smallest_total = 2e7;  // operations: below, waiting for threads costs more
  constexpr double largest_part = 1.0 / 6.0;
  const int fronts = static_cast<int>(tree.fronts.size());
  std::vector<double> work(fronts, 0.0);
  std::vector<int> begin(fronts);  // of the subtree, which is contiguous
  double total = 0.0;
  for (int f = 0; f < fronts; ++f) begin[f] = f;
  for (int f = 0; f < fronts; ++f) {
    const double own = operations_of(tree.fronts[f]);
    work[f] += own;
    total += own;
    const int parent = tree.fronts[f].parent;
    if (parent < 0) continue;
    work[parent] += work[f];
    begin[parent] = std::min(begin[parent], begin[f]);
  }
  if (total < smallest_total) {
    layout.branches = {{0, fronts}};
    return;
  }
  const auto is_trunk = [&](int f) { return work[f] > largest_part * total; };
  for (int f = 0; f < fronts; ++f) {
    const int parent = tree.fronts[f].parent;
    if (is_trunk(f))
      layout.trunk.push_back(f);
    else if (parent < 0 || is_trunk(parent))
      layout.branches.push_back({begin[f], f + 1});
  }
}

}  // namespace

double operations_of(const Front& front) {
  // 2/3 k^3 for L11 U11, k^2 m each for L21 and U12, 2 k m^2 for S, with k own and m boundary rows.
  const double own = front.own, outside = front.boundary();
  return 2.0 / 3.0 * own * own * own + 2.0 * own * own * outside + 2.0 * own * outside * outside;
}

FrontLayout make_front_layout(const FrontTree& tree) {
  FrontLayout layout;
  layout.numbers_begin.assign(1, 0);
  for (const Front& front : tree.fronts) {
    const std::int64_t rows = front.rows, own = front.own;
    layout.numbers_begin.push_back(layout.numbers_begin.back() + rows * own +
                                   own * front.boundary());
  }
  layout.boundary_made.resize(tree.fronts.size());
  layout.boundary_kept.resize(tree.fronts.size());
  share_out(tree, layout);
  std::vector<int> numbers;
  for (const auto& [first, end] : layout.branches) {
    numbers.clear();
    for (int f = first; f < end; ++f) numbers.push_back(f);
    layout.boundaries = stack_boundaries(tree, numbers, layout.boundaries, layout);
  }
  layout.boundaries = stack_boundaries(tree, layout.trunk, layout.boundaries, layout);
  return layout;
}

}  // namespace ballast
