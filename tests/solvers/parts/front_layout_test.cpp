#include "solvers/parts/front_layout.hpp"

#include <algorithm>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// A square grid of nodes with three unknowns each, eliminated in the order of a binary dissection.
FrontTree grid_tree(int side) {
  BlockGraph graph;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      graph.unknown_begin.push_back(graph.unknown_begin.back() + 3);
      if (i > 0) graph.neighbour.push_back((i - 1) * side + j);
      if (j > 0) graph.neighbour.push_back(i * side + j - 1);
      if (j + 1 < side) graph.neighbour.push_back(i * side + j + 1);
      if (i + 1 < side) graph.neighbour.push_back((i + 1) * side + j);
      graph.begin.push_back(static_cast<int>(graph.neighbour.size()));
    }
  // The middle row of nodes last, the middles of both halves before it, and so on.
  std::vector<int> order;
  const auto dissect = [&](auto& self, int first, int last) -> void {
    if (first > last) return;
    const int middle = (first + last) / 2;
    self(self, first, middle - 1);
    self(self, middle + 1, last);
    for (int j = 0; j < side; ++j) order.push_back(middle * side + j);
  };
  dissect(dissect, 0, side - 1);
  return make_front_tree(graph, order);
}

}  // namespace

TEST_CASE("subtrees share no front, and with those above them they are all fronts", "[factors]") {
  for (const int side : {1, 3, 20}) {
    const FrontTree tree = grid_tree(side);
    const FrontLayout layout = make_front_layout(tree);
    std::vector<int> owner(tree.fronts.size(), -1), seen(tree.fronts.size(), 0);
    for (size_t s = 0; s < layout.subtrees.size(); ++s)
      for (int f = layout.subtrees[s].begin; f < layout.subtrees[s].end; ++f) {
        owner[f] = static_cast<int>(s);
        ++seen[f];
      }
    for (const int f : layout.above) ++seen[f];
    CHECK(std::all_of(seen.begin(), seen.end(), [](int count) { return count == 1; }));
    // Nothing in a subtree has a parent in another one.
    for (size_t f = 0; f < tree.fronts.size(); ++f) {
      const int parent = tree.fronts[f].parent;
      if (owner[f] >= 0 && parent >= 0) CHECK((owner[parent] == owner[f] || owner[parent] < 0));
      if (owner[f] < 0 && parent >= 0) CHECK(owner[parent] < 0);
    }
    if (side == 20) CHECK(layout.subtrees.size() > 4);
  }
}

TEST_CASE("no boundary is overwritten before its parent has taken it", "[factors]") {
  const FrontTree tree = grid_tree(20);
  const FrontLayout layout = make_front_layout(tree);
  const auto size = [&](int f) {
    return static_cast<std::int64_t>(tree.fronts[f].boundary()) * tree.fronts[f].boundary();
  };
  // Every number belongs to the front whose boundary waits there; -1: to none.
  std::vector<int> holder(layout.boundary_numbers, -1);
  for (int f = 0; f < static_cast<int>(tree.fronts.size()); ++f) {
    int overwritten = 0;
    for (std::int64_t i = 0; i < size(f); ++i) overwritten += holder[layout.made_at[f] + i] >= 0;
    CHECK(overwritten == 0);
    for (int& h : holder)
      if (h >= 0 && tree.fronts[h].parent == f) h = -1;
    for (std::int64_t i = 0; i < size(f); ++i) {
      int& h = holder[layout.kept_at[f] + i];
      overwritten += h >= 0;
      h = f;
    }
    CHECK(overwritten == 0);
  }
}
