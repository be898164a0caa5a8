#include "solvers/parts/front_tree.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

BlockGraph graph_of(const std::vector<int>& sizes, const std::vector<std::pair<int, int>>& edges) {
  std::vector<int> begin{0};
  for (const int size : sizes) begin.push_back(begin.back() + size);
  // One entry for each edge, in the column of its first node.
  std::vector<int> outer(begin.back() + 1, 0), inner;
  for (int k = 0; k < static_cast<int>(sizes.size()); ++k)
    for (int j = begin[k]; j < begin[k + 1]; ++j) {
      if (j == begin[k])
        for (const auto& [a, b] : edges)
          if (a == k) inner.push_back(begin[b]);
      outer[j + 1] = static_cast<int>(inner.size());
    }
  return block_graph(begin, outer.data(), inner.data());
}

BlockGraph random_graph(int nodes, int edges, std::uint64_t seed) {
  Random random(seed);
  std::vector<int> sizes;
  for (int k = 0; k < nodes; ++k) sizes.push_back(1 + static_cast<int>(random.uniform() * 6));
  std::vector<std::pair<int, int>> pairs;
  for (int k = 0; k < edges; ++k) {
    const int a = static_cast<int>(random.uniform() * nodes),
              b = static_cast<int>(random.uniform() * nodes);
    if (a != b) pairs.push_back({a, b});
  }
  return graph_of(sizes, pairs);
}

/// The slow twin: the pattern of nonzeros after eliminating the unknowns one by one, by position.
std::vector<std::vector<bool>> filled(const BlockGraph& graph, const FrontTree& tree) {
  const int n = graph.unknown_count();
  std::vector<std::vector<bool>> full(n, std::vector<bool>(n, false));
  const auto join = [&](int a, int b) {
    for (int i = graph.unknown_begin[a]; i < graph.unknown_begin[a + 1]; ++i)
      for (int j = graph.unknown_begin[b]; j < graph.unknown_begin[b + 1]; ++j)
        full[tree.place[i]][tree.place[j]] = full[tree.place[j]][tree.place[i]] = true;
  };
  for (int k = 0; k < graph.node_count(); ++k) {
    join(k, k);
    for (int i = graph.begin[k]; i < graph.begin[k + 1]; ++i) join(k, graph.neighbour[i]);
  }
  for (int k = 0; k < n; ++k)
    for (int i = k + 1; i < n; ++i)
      for (int j = k + 1; j < n; ++j)
        if (full[i][k] && full[k][j]) full[i][j] = true;
  return full;
}

}  // namespace

TEST_CASE("a graph of blocks has every edge from both ends, once") {
  const BlockGraph graph = graph_of({2, 1, 3}, {{0, 2}, {2, 0}, {2, 1}, {0, 2}});
  CHECK(graph.neighbour == std::vector<int>{2, 2, 0, 1});
  CHECK(graph.begin == std::vector<int>{0, 1, 2, 4});
  CHECK(graph.unknown_count() == 6);
}

TEST_CASE("fronts hold all that elimination fills, and each unknown is eliminated once") {
  for (const int edges : {0, 10, 40, 150})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(edges, seed);
      const BlockGraph graph = random_graph(30, edges, seed);
      std::vector<int> order(graph.node_count());
      std::iota(order.begin(), order.end(), 0);
      std::reverse(order.begin(), order.end());
      const FrontTree tree = make_front_tree(graph, order);

      std::set<int> places(tree.place.begin(), tree.place.end());
      CHECK(static_cast<int>(places.size()) == graph.unknown_count());
      const auto full = filled(graph, tree);
      int eliminated = 0;
      for (const Front& front : tree.fronts) {
        CHECK(front.first == eliminated);
        eliminated += front.own;
        const auto begin = tree.places.begin() + front.rows_begin;
        CHECK(std::is_sorted(begin, begin + front.rows));
        for (int k = front.first; k < front.first + front.own; ++k)
          for (int i = k; i < graph.unknown_count(); ++i)
            if (full[i][k]) CHECK(std::binary_search(begin, begin + front.rows, i));
      }
      CHECK(eliminated == graph.unknown_count());
    }
}

TEST_CASE("what a front passes on is in its parent, and children lie on top of a stack") {
  const BlockGraph graph = random_graph(60, 120, 9);
  std::vector<int> order(graph.node_count());
  std::iota(order.begin(), order.end(), 0);
  const FrontTree tree = make_front_tree(graph, order);
  std::vector<int> stack;
  for (int f = 0; f < static_cast<int>(tree.fronts.size()); ++f) {
    const Front& front = tree.fronts[f];
    for (int k = 0; k < front.child_count; ++k) {
      REQUIRE_FALSE(stack.empty());
      CHECK(tree.fronts[stack.back()].parent == f);
      stack.pop_back();
    }
    CHECK((front.parent < 0) == (front.boundary() == 0));
    if (front.parent < 0) continue;
    CHECK(front.parent > f);
    stack.push_back(f);
    const Front& parent = tree.fronts[front.parent];
    for (int i = front.own; i < front.rows; ++i) {
      const int row = tree.row_in_parent[front.rows_begin + i];
      REQUIRE(row >= 0);
      REQUIRE(row < parent.rows);
      CHECK(tree.places[parent.rows_begin + row] == tree.places[front.rows_begin + i]);
    }
  }
  CHECK(stack.empty());
}

TEST_CASE("a clique is one front, a star's leaves keep theirs") {
  std::vector<std::pair<int, int>> clique, star;
  for (int a = 0; a < 12; ++a) {
    for (int b = 0; b < a; ++b) clique.push_back({a, b});
    if (a > 0) star.push_back({0, a});
  }
  const std::vector<int> sizes(12, 6);
  std::vector<int> order(12);
  std::iota(order.rbegin(), order.rend(), 0);  // the centre is last
  CHECK(make_front_tree(graph_of(sizes, clique), order).fronts.size() == 1);
  const FrontTree leaves = make_front_tree(graph_of(sizes, star), order);
  CHECK(leaves.fronts.size() >= 10);
  CHECK(leaves.fronts.back().child_count == static_cast<int>(leaves.fronts.size()) - 1);
  CHECK(leaves.trunk.empty());  // a small tree is one branch
  CHECK(leaves.branches.size() == 1);
}
