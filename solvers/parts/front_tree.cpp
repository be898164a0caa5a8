#include "solvers/parts/front_tree.hpp"

#include <algorithm>
#include <numeric>

namespace ballast {
namespace {

/// The elimination tree on nodes numbered by the order of elimination.
struct NodeTree {
  std::vector<int> parent;                 ///< -1: a root
  std::vector<std::vector<int>> boundary;  ///< nodes eliminated later that a node sees, ascending
};

/// An order with every subtree of the elimination tree in one piece, children before parents.
std::vector<int> postorder(const std::vector<int>& parent, const std::vector<int>& weight) {
  const int n = static_cast<int>(parent.size());
  // The heaviest child comes last: only the last one can be joined with its parent.
  std::vector<std::vector<int>> children(n);
  std::vector<int> roots;
  for (int k = 0; k < n; ++k) (parent[k] < 0 ? roots : children[parent[k]]).push_back(k);
  for (std::vector<int>& list : children)
    std::stable_sort(list.begin(), list.end(), [&](int a, int b) { return weight[a] < weight[b]; });
  // Depth first with an explicit stack: a chain of bodies can make the tree as deep as it is long.
  std::vector<int> result, stack;
  std::vector<std::size_t> next(n, 0);
  for (const int root : roots) {
    stack.push_back(root);
    while (!stack.empty()) {
      const int k = stack.back();
      if (next[k] < children[k].size()) {
        stack.push_back(children[k][next[k]++]);
      } else {
        result.push_back(k);
        stack.pop_back();
      }
    }
  }
  return result;
}

/// The tree, with the nodes that every node sees when its turn comes: its own later neighbours and
/// those that its children saw.
NodeTree eliminate(const BlockGraph& graph, const std::vector<int>& order) {
  // Eliminating a node makes all later nodes that it sees neighbours of one another. So the first
  // of them is its parent, and sees the others. For a chain a - b - c - d in the order a, c, b, d
  //
  //     turn 0 (a) sees 2   turn 1 (c) sees 2, 3   turn 2 (b) sees 3 through c   turn 3 (d): root
  const int n = graph.node_count();
  std::vector<int> turn(n);
  for (int k = 0; k < n; ++k) turn[order[k]] = k;
  NodeTree tree{std::vector<int>(n, -1), std::vector<std::vector<int>>(n)};
  std::vector<std::vector<int>> children(n);
  std::vector<int> seen(n, -1);
  for (int k = 0; k < n; ++k) {
    std::vector<int>& boundary = tree.boundary[k];
    seen[k] = k;
    const auto see = [&](int other) {
      if (other < k || seen[other] == k) return;
      seen[other] = k;
      boundary.push_back(other);
    };
    for (int i = graph.begin[order[k]]; i < graph.begin[order[k] + 1]; ++i)
      see(turn[graph.neighbour[i]]);
    for (const int child : children[k])
      for (const int other : tree.boundary[child]) see(other);
    std::sort(boundary.begin(), boundary.end());
    if (boundary.empty()) continue;
    tree.parent[k] = boundary.front();
    children[boundary.front()].push_back(k);
  }
  return tree;
}

/// Some consecutive nodes that become one front.
struct Group {
  int first_node, last_node;  ///< inclusive; the boundary is the last node's
  int own;                    ///< unknowns
  double zeros = 0.0;         ///< stored zeros that no elimination fills
};

/// Entries of a front's columns on and below the diagonal.
double entries(double own, double boundary) { return own * (own + 1.0) / 2.0 + own * boundary; }

/// Small fronts are joined readily, large ones only where hardly a zero is stored. The thresholds
/// are CHOLMOD's, in unknowns.
bool worth_joining(int own, double zero_share) {
  if (own <= 4 || zero_share == 0.0) return true;
  if (own <= 16) return zero_share < 0.8;
  if (own <= 48) return zero_share < 0.1;
  return zero_share < 0.05;
}

/// Makes each node a group and joins it with the group before it wherever that is its child and
/// joining pays. `size` in unknowns, `seen[k]`: unknowns on node k's boundary.
std::vector<Group> join(const NodeTree& tree, const std::vector<int>& size,
                        const std::vector<int>& seen) {
  std::vector<Group> groups;
  for (int k = 0; k < static_cast<int>(size.size()); ++k) {
    groups.push_back({k, k, size[k]});
    while (groups.size() > 1) {
      const Group &child = groups[groups.size() - 2], &parent = groups.back();
      // In this order the group before is a child exactly where its parent lies within this group.
      if (tree.parent[child.last_node] < 0 || tree.parent[child.last_node] > parent.last_node)
        break;
      const int own = child.own + parent.own, boundary = seen[parent.last_node];
      // The child's columns get all rows of the joined front: those that it did not see hold zeros.
      const double zeros =
          child.zeros + parent.zeros +
          static_cast<double>(child.own) * (parent.own + boundary - seen[child.last_node]);
      if (!worth_joining(own, zeros / entries(own, boundary))) break;
      const Group joined{child.first_node, parent.last_node, own, zeros};
      groups.pop_back();
      groups.back() = joined;
    }
  }
  return groups;
}

/// Multiplications and additions of one front's elimination.
double operations_of(const Front& front) {
  // 2/3 k^3 for L11 U11, k^2 m each for L21 and U12, 2 k m^2 for S, with k own and m boundary rows.
  const double own = front.own, outside = front.boundary();
  return 2.0 / 3.0 * own * own * own + 2.0 * own * own * outside + 2.0 * own * outside * outside;
}

/// Moves fronts from the top of the tree into the trunk until no remaining subtree, a branch, is a
/// large part of the whole work.
void share_out(FrontTree& tree) {
  constexpr double smallest_total = 2e7;  // operations; below it, waiting for threads costs more
  constexpr double largest_part = 1.0 / 6.0;
  const int fronts = static_cast<int>(tree.fronts.size());
  std::vector<double> work(fronts, 0.0);
  std::vector<int> begin(fronts);  // first front of each subtree, which is contiguous
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
    tree.branches = {{0, fronts}};
    return;
  }
  const auto is_trunk = [&](int f) { return work[f] > largest_part * total; };
  for (int f = 0; f < fronts; ++f) {
    const int parent = tree.fronts[f].parent;
    if (is_trunk(f))
      tree.trunk.push_back(f);
    else if (parent < 0 || is_trunk(parent))
      tree.branches.push_back({begin[f], f + 1});
  }
}

/// Stacks the boundaries of these fronts, children before parents, behind all earlier stacks.
void stack_boundaries(FrontTree& tree, const std::vector<int>& numbers) {
  const auto size = [&](int f) {
    return static_cast<std::int64_t>(tree.fronts[f].boundary()) * tree.fronts[f].boundary();
  };
  std::vector<int> waiting;
  std::int64_t top = tree.boundaries;
  for (const int f : numbers) {
    tree.fronts[f].boundary_made_at = top;
    tree.boundaries = std::max(tree.boundaries, top + size(f));
    for (; !waiting.empty() && tree.fronts[waiting.back()].parent == f; waiting.pop_back())
      top -= size(waiting.back());
    tree.fronts[f].boundary_kept_at = top;
    top += size(f);
    waiting.push_back(f);
  }
}

void lay_out(FrontTree& tree) {
  for (Front& front : tree.fronts) {
    front.numbers_at = tree.numbers;
    tree.numbers += static_cast<std::int64_t>(front.own) * (front.rows + front.boundary());
  }
  for (const auto& [first, end] : tree.branches) {
    std::vector<int> numbers(end - first);
    std::iota(numbers.begin(), numbers.end(), first);
    stack_boundaries(tree, numbers);
  }
  stack_boundaries(tree, tree.trunk);
}

}  // namespace

BlockGraph block_graph(const std::vector<int>& unknown_begin, const int* outer, const int* inner) {
  BlockGraph graph;
  graph.unknown_begin = unknown_begin;
  const int nodes = graph.node_count();
  std::vector<int> node_of(graph.unknown_count());
  for (int k = 0; k < nodes; ++k)
    std::fill(node_of.begin() + unknown_begin[k], node_of.begin() + unknown_begin[k + 1], k);
  std::vector<std::vector<int>> near(nodes);
  std::vector<int> met(nodes, -1);
  for (int k = 0; k < nodes; ++k) {
    met[k] = k;
    for (int i = outer[unknown_begin[k]]; i < outer[unknown_begin[k + 1]]; ++i) {
      const int other = node_of[inner[i]];
      if (met[other] == k) continue;
      met[other] = k;
      near[k].push_back(other);
      near[other].push_back(k);
    }
  }
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    graph.neighbour.insert(graph.neighbour.end(), list.begin(), list.end());
    graph.begin.push_back(static_cast<int>(graph.neighbour.size()));
  }
  return graph;
}

FrontTree make_front_tree(const BlockGraph& graph, const std::vector<int>& order) {
  const int nodes = graph.node_count();
  const NodeTree unordered = eliminate(graph, order);
  std::vector<int> weight(nodes);
  for (int k = 0; k < nodes; ++k) weight[k] = static_cast<int>(unordered.boundary[k].size());
  std::vector<int> ordered = postorder(unordered.parent, weight);
  for (int& k : ordered) k = order[k];
  const NodeTree tree = eliminate(graph, ordered);

  FrontTree result;
  result.place.resize(graph.unknown_count());
  std::vector<int> size(nodes), seen(nodes, 0), node_place(nodes + 1, 0);
  for (int k = 0; k < nodes; ++k) {
    size[k] = graph.size(ordered[k]);
    node_place[k + 1] = node_place[k] + size[k];
    for (int i = 0; i < size[k]; ++i)
      result.place[graph.unknown_begin[ordered[k]] + i] = node_place[k] + i;
  }
  for (int k = 0; k < nodes; ++k)
    for (const int other : tree.boundary[k]) seen[k] += size[other];

  const std::vector<Group> groups = join(tree, size, seen);
  std::vector<int> front_of(nodes);
  for (int f = 0; f < static_cast<int>(groups.size()); ++f) {
    const Group& group = groups[f];
    std::fill(front_of.begin() + group.first_node, front_of.begin() + group.last_node + 1, f);
    Front front{.first = node_place[group.first_node],
                .own = group.own,
                .rows = group.own + seen[group.last_node],
                .rows_begin = static_cast<int>(result.places.size())};
    for (int i = 0; i < front.own; ++i) result.places.push_back(front.first + i);
    for (const int node : tree.boundary[group.last_node])
      for (int i = 0; i < size[node]; ++i) result.places.push_back(node_place[node] + i);
    result.fronts.push_back(front);
  }
  result.row_in_parent.assign(result.places.size(), -1);
  for (int f = 0; f < static_cast<int>(groups.size()); ++f) {
    Front& front = result.fronts[f];
    const int parent = tree.parent[groups[f].last_node];
    if (parent < 0) continue;
    front.parent = front_of[parent];
    ++result.fronts[front.parent].child_count;
    // A front's boundary lies within the rows of its parent, and both lists ascend: one walk finds
    // all rows.
    int row = result.fronts[front.parent].rows_begin;
    for (int i = front.rows_begin + front.own; i < front.rows_begin + front.rows; ++i) {
      while (result.places[row] != result.places[i]) ++row;
      result.row_in_parent[i] = row - result.fronts[front.parent].rows_begin;
    }
  }
  share_out(result);
  lay_out(result);
  return result;
}

}  // namespace ballast
