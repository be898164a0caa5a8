#pragma once
// What a run's user must be told without asking: steps that missed their tolerance, overlaps that
// can be seen, energy that no law of contact gives. And what to do about each.

#include <string>
#include <vector>

#include "experiments/measure/run_summary.hpp"

namespace ballast {

/// An overlap of this part of the smallest radius, and gained energy of this part of what moved,
/// can be seen.
inline constexpr double visible_overlap = 0.01, visible_gain = 0.01;

/// Nothing has to be said.
bool is_clean(const RunSummary& run);

/// One sentence on each thing, the finding first and what to do about it behind; a single one when
/// there is nothing to do.
std::vector<std::string> trust_words(const RunSummary& run);

}  // namespace ballast
