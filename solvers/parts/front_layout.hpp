#pragma once
// Where the numbers of a multifrontal factorisation lie, and what can be done at the same time.
// Pure bookkeeping on a FrontTree, without any library.

#include <cstdint>
#include <utility>
#include <vector>

#include "solvers/parts/front_tree.hpp"

namespace ballast {

/// Branches are subtrees without a common front: different threads may eliminate them. The trunk is
/// what stands above them, front by front.
///
///   trunk                      the largest fronts: their columns are shared out
///     +-- branch, branch, ...  many fronts each
///
/// They follow from the tree alone, never from the number of threads.
struct FrontLayout {
  /// Fronts [first, second) of every branch.
  std::vector<std::pair<int, int>> branches;
  std::vector<int> trunk;  ///< ascending: children before parents
  /// A front's numbers, fronts + 1: its own columns (rows x own, column-major), in which L below
  /// and U above the diagonal come to stand, then the rest of its own rows (own x boundary).
  std::vector<std::int64_t> numbers_begin;
  /// A front's boundary (boundary x boundary, column-major) is made above those of its children,
  /// and then moved down over them, where it waits for its parent:
  ///
  ///     | .. | child 1 | child 2 | own |    ->    | .. | own |
  ///
  /// Every branch has such a stack of its own, and the trunk one.
  std::vector<std::int64_t> boundary_made, boundary_kept;  ///< by front
  std::int64_t boundaries = 0;                             ///< numbers of all stacks
};

/// Multiplications and additions of one front's elimination.
double operations_of(const Front& front);

/// A small tree is one branch.
FrontLayout make_front_layout(const FrontTree& tree);

}  // namespace ballast
