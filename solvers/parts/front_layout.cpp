#include "solvers/parts/front_layout.hpp"

#include <algorithm>

namespace ballast {
namespace {

std::int64_t boundary_size(const Front& front) {
  return static_cast<std::int64_t>(front.boundary()) * front.boundary();
}

/// Subtrees of at most a sixteenth of all work: enough of them to keep a few threads busy.
void cut_subtrees(const FrontTree& tree, FrontLayout& layout) {
  const int fronts = static_cast<int>(tree.fronts.size());
  std::vector<double> work(fronts, 0.0);  // of the subtree under each front
  std::vector<int> first(fronts);         // and that subtree's first front
  double all = 0.0;
  for (int f = 0; f < fronts; ++f) first[f] = f;
  for (int f = 0; f < fronts; ++f) {
    const Front& front = tree.fronts[f];
    const double own = operations_of(front);
    all += own;
    work[f] += own;
    if (front.parent < 0) continue;
    work[front.parent] += work[f];
    first[front.parent] = std::min(first[front.parent], first[f]);
  }
  // The largest ones that are small enough.
  const auto is_small = [&](int f) { return work[f] <= all / 16.0; };
  for (int f = 0; f < fronts; ++f) {
    const int parent = tree.fronts[f].parent;
    if (!is_small(f))
      layout.above.push_back(f);
    else if (parent < 0 || !is_small(parent))
      layout.subtrees.push_back({first[f], f + 1});
  }
}

/// The boundaries of one subtree as a stack that begins at `begin`. Returns its greatest height.
std::int64_t stack_boundaries(const FrontTree& tree, const FrontLayout::Subtree& subtree,
                              std::int64_t begin, FrontLayout& layout) {
  std::vector<int> waiting;
  std::int64_t top = begin, highest = begin;
  for (int f = subtree.begin; f < subtree.end; ++f) {
    const Front& front = tree.fronts[f];
    layout.made_at[f] = top;
    highest = std::max(highest, top + boundary_size(front));
    for (int k = 0; k < front.child_count; ++k, waiting.pop_back())
      top -= boundary_size(tree.fronts[waiting.back()]);
    layout.kept_at[f] = top;
    waiting.push_back(f);
    top += boundary_size(front);
  }
  return highest;
}

}  // namespace

double operations_of(const Front& front) {
  // 2/3 k^3 for L11 U11, k^2 m each for L21 and U12, 2 k m^2 for S, with k own and m boundary rows.
  const double own = front.own, outside = front.boundary();
  return 2.0 / 3.0 * own * own * own + 2.0 * own * own * outside + 2.0 * own * outside * outside;
}

FrontLayout make_front_layout(const FrontTree& tree) {
  FrontLayout layout;
  for (const Front& front : tree.fronts) {
    const std::int64_t rows = front.rows, own = front.own;
    layout.numbers_begin.push_back(layout.numbers_begin.back() + rows * own +
                                   own * front.boundary());
  }
  cut_subtrees(tree, layout);
  layout.made_at.assign(tree.fronts.size(), 0);
  layout.kept_at.assign(tree.fronts.size(), 0);
  std::int64_t end = 0;
  for (const FrontLayout::Subtree& subtree : layout.subtrees)
    end = stack_boundaries(tree, subtree, end, layout);
  // The few above keep theirs where they are made.
  for (const int f : layout.above) {
    layout.made_at[f] = layout.kept_at[f] = end;
    end += boundary_size(tree.fronts[f]);
  }
  layout.boundary_numbers = end;
  return layout;
}

}  // namespace ballast
