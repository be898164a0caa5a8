#pragma once
// Where a multifrontal factorisation keeps its numbers, and which fronts can be eliminated at the
// same time. Bookkeeping on a FrontTree, like the tree itself.

#include <cstdint>
#include <vector>

#include "solvers/parts/front_tree.hpp"

namespace ballast {

/// What the elimination of a front costs: multiplications and additions in dense blocks.
double operations_of(const Front& front);

struct FrontLayout {
  /// Fronts [begin, end): one front and all that are below it.
  struct Subtree {
    int begin, end;
  };
  /// Subtrees that have nothing to do with each other, ascending, and the fronts above them all.
  /// They depend on the tree alone, not on how many threads there are.
  std::vector<Subtree> subtrees;
  std::vector<int> above;
  /// A front's rows x own numbers and then own x boundary ones begin here; fronts + 1.
  std::vector<std::int64_t> numbers_begin{0};
  /// Where a front's boundary (boundary x boundary numbers) is made, and where it then waits for
  /// its parent: in a subtree boundaries lie one on the other, and a front's own is made above
  /// those of its children and takes their place.
  ///
  ///     | .. | child 1 | child 2 | own |    ->    | .. | own |
  std::vector<std::int64_t> made_at, kept_at;
  std::int64_t boundary_numbers = 0;  ///< room for all boundaries
};

FrontLayout make_front_layout(const FrontTree& tree);

}  // namespace ballast
