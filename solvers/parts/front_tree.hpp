#pragma once
// The symbolic half of a multifrontal factorisation: which unknowns are eliminated together, which
// rows their elimination touches, where its numbers lie, and which fronts can be eliminated at the
// same time. It is bookkeeping on a graph, without any library.
//
// Unknowns come in blocks, one per node of a graph (a body has six, a contact three), and are
// always eliminated block by block. So the analysis looks at thousands of nodes, not at tens of
// thousands of unknowns. Liu 1992, "The multifrontal method for sparse matrix solution".

#include <cstdint>
#include <utility>
#include <vector>

namespace ballast {

/// Nodes, each with some unknowns, and their neighbours.
struct BlockGraph {
  std::vector<int> unknown_begin{0};  ///< node k has unknowns unknown_begin[k] ..; nodes + 1
  std::vector<int> begin{0};          ///< of each node's neighbours; nodes + 1
  std::vector<int> neighbour;  ///< ascending, each edge from both ends, never the node itself

  int node_count() const { return static_cast<int>(unknown_begin.size()) - 1; }
  int unknown_count() const { return unknown_begin.back(); }
  int size(int node) const { return unknown_begin[node + 1] - unknown_begin[node]; }
};

/// The graph of a square matrix in columns (`outer`, `inner` as Eigen stores them) whose unknowns
/// come in blocks: nodes are neighbours where any entry, on either side of the diagonal, joins
/// them.
BlockGraph block_graph(const std::vector<int>& unknown_begin, const int* outer, const int* inner);

/// A front eliminates its own unknowns and passes the remaining dense matrix, on its boundary, to
/// its parent. A place is an unknown's number in the order of elimination.
struct Front {
  int first = 0;        ///< place of its first own unknown; the others follow
  int own = 0;          ///< number of unknowns that it eliminates
  int rows = 0;         ///< number of rows: its own, then its boundary
  int rows_begin = 0;   ///< in FrontTree::places: the places of all its rows, ascending
  int parent = -1;      ///< -1: a root, whose boundary is empty
  int child_count = 0;  ///< its children are the last fronts before it without a parent yet
  /// Where its numbers begin: its own columns (rows x own, column-major), which become L below and
  /// U above the diagonal, then the rest of its own rows (own x boundary).
  std::int64_t numbers_at = 0;
  /// The matrix that it passes on (boundary x boundary, column-major) is made above those of its
  /// children, and then moved down over them, where it waits for its parent:
  ///
  ///     | .. | child 1 | child 2 | own |    ->    | .. | own |
  ///
  /// Every branch has a stack of its own, and so has the trunk.
  std::int64_t boundary_made_at = 0, boundary_kept_at = 0;
  int boundary() const { return rows - own; }
};

/// All fronts, children before parents. Branches are subtrees without a common front: different
/// threads may eliminate them. The trunk consists of the fronts above them, eliminated one by one.
///
///   trunk                      the largest fronts: their columns are shared out
///     +-- branch, branch, ...  many fronts each
///
/// Both follow from the tree alone, never from the number of threads. A small tree is one branch.
struct FrontTree {
  std::vector<int> place;  ///< of every unknown
  std::vector<Front> fronts;
  std::vector<int> places;  ///< see Front::rows_begin
  /// Parallel to `places`: the row of a boundary row in the parent's front; -1 for own rows.
  std::vector<int> row_in_parent;
  std::vector<std::pair<int, int>> branches;  ///< fronts [first, second) of each
  std::vector<int> trunk;                     ///< ascending: children before parents
  std::int64_t numbers = 0, boundaries = 0;   ///< sizes: of all fronts; of all stacks
};

/// `order[k]` is the node to eliminate k-th; the tree may exchange nodes that do not see each
/// other. Small or nearly equal fronts are joined: some zeros are stored for larger dense blocks.
FrontTree make_front_tree(const BlockGraph& graph, const std::vector<int>& order);

}  // namespace ballast
