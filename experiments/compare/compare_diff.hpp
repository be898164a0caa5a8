#pragma once
// Two comparisons of the same cases, before and after a change: what has become of each solve.

#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_row.hpp"

namespace ballast {

enum class Change { same, faster, slower, lost, gained, only_before, only_after };

const char* name_of(Change change);

/// One backend on one case to one tolerance from one start.
struct ChangedSolve {
  std::string case_name, solver;
  double tolerance = 0.0;
  StartKind start = StartKind::cold;
  Change change = Change::same;
  double before = 0.0, after = 0.0;  ///< median of the solved repeats [s]; 0: none is solved
  double spread = 1.0;  ///< how far the repeats of one side are apart, as a factor; the larger one
};

/// Pairs rows by what the problem holds, not by its name. A solve is faster or slower when its
/// median changed by more than the factor `least` and by more than its own spread; with `least`
/// infinite times are not compared. It is `lost` when it was solved in every repeat before and is
/// not now. What matters comes first: lost, slower, then the rest by name.
std::vector<ChangedSolve> compare_diff(std::span<const CompareRow> before,
                                       std::span<const CompareRow> after, double least);

}  // namespace ballast
