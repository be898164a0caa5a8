#include "solvers/parts/front_layout.hpp"

#include <algorithm>
#include <numeric>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The fronts of a dissected chain of cubes: a full binary tree, children before parents, each
/// level's fronts larger than those below.
FrontTree binary_tree(int levels, int own) {
  FrontTree tree;
  const auto add = [&](const auto& self, int level) -> int {
    std::vector<int> children;
    if (level > 0) children = {self(self, level - 1), self(self, level - 1)};
    Front front;
    front.own = own << level;
    front.rows = level + 1 == levels ? front.own : 2 * front.own;
    front.child_count = static_cast<int>(children.size());
    tree.fronts.push_back(front);
    const int number = static_cast<int>(tree.fronts.size()) - 1;
    for (const int child : children) tree.fronts[child].parent = number;
    return number;
  };
  add(add, levels - 1);
  return tree;
}

}  // namespace

TEST_CASE("branches and trunk hold every front once, and no branch is large") {
  const FrontTree tree = binary_tree(6, 12);
  const FrontLayout layout = make_front_layout(tree);
  const int fronts = static_cast<int>(tree.fronts.size());
  std::vector<int> seen(fronts, 0), branch_of(fronts, -1);
  double total = 0.0;
  for (const Front& front : tree.fronts) total += operations_of(front);
  REQUIRE(layout.branches.size() > 2);
  for (size_t k = 0; k < layout.branches.size(); ++k) {
    double work = 0.0;
    for (int f = layout.branches[k].first; f < layout.branches[k].second; ++f) {
      ++seen[f];
      branch_of[f] = static_cast<int>(k);
      work += operations_of(tree.fronts[f]);
    }
    CHECK(work <= total / 6.0);
  }
  for (const int f : layout.trunk) ++seen[f];
  CHECK(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  // Only through the trunk does one branch depend on another.
  for (int f = 0; f < fronts; ++f) {
    const int parent = tree.fronts[f].parent;
    if (branch_of[f] >= 0 && parent >= 0)
      CHECK((branch_of[parent] == branch_of[f] || branch_of[parent] < 0));
  }
  CHECK(std::is_sorted(layout.trunk.begin(), layout.trunk.end()));
}

TEST_CASE("a boundary that waits is never written over") {
  const FrontTree tree = binary_tree(6, 12);
  const FrontLayout layout = make_front_layout(tree);
  // The slow twin: an owner for every number. Branches in any order, here the last one first.
  std::vector<int> owner(layout.boundaries, -1), order;
  for (auto it = layout.branches.rbegin(); it != layout.branches.rend(); ++it)
    for (int f = it->first; f < it->second; ++f) order.push_back(f);
  order.insert(order.end(), layout.trunk.begin(), layout.trunk.end());
  for (const int f : order) {
    const Front& front = tree.fronts[f];
    const auto size = static_cast<std::int64_t>(front.boundary()) * front.boundary();
    // It is made where nobody waits; then its children are there, each whole, and go.
    for (std::int64_t i = 0; i < size; ++i) CHECK(owner[layout.boundary_made[f] + i] == -1);
    for (int child = 0; child < f; ++child) {
      if (tree.fronts[child].parent != f) continue;
      const auto waiting = owner.begin() + layout.boundary_kept[child];
      const std::int64_t own = tree.fronts[child].boundary();
      CHECK(std::count(waiting, waiting + own * own, child) == own * own);
      std::fill_n(waiting, own * own, -1);
    }
    if (front.parent >= 0) std::fill_n(owner.begin() + layout.boundary_kept[f], size, f);
  }
}

TEST_CASE("a small tree is one branch") {
  const FrontTree tree = binary_tree(3, 2);
  const FrontLayout layout = make_front_layout(tree);
  CHECK(layout.trunk.empty());
  CHECK(layout.branches == std::vector<std::pair<int, int>>{{0, 7}});
}
