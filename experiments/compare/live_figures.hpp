#pragma once
// Figures of a closed-loop comparison: one line for every trajectory.

#include <vector>

#include "experiments/compare/live.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Those of the wall only with a driven wall, distances only with a reference. A figure of which
/// nothing is known has no panels.
std::vector<page::Picture> live_figures(const LiveComparison& comparison);

}  // namespace ballast
