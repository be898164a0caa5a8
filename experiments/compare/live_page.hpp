#pragma once
// The page of a closed-loop comparison, with its tables as CSV.

#include <filesystem>

#include "experiments/compare/live.hpp"

namespace ballast {

/// Reads manifest.json of `folder`; writes live.csv (one row per trajectory), trajectories as
/// steps-<solver>-<tolerance>.csv, figures/*.svg and live.html there. Throws Error.
void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison);

}  // namespace ballast
