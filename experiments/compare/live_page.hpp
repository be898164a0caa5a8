#pragma once
// What a closed-loop comparison shows: numbers and figures of its trajectories, a page, CSV files.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/live.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// What a trajectory came to in one number: a column of live.csv, and one of the page's table where
/// it has a head.
struct LiveNumber {
  const char* name;  ///< of live.csv, in SI units, or ms as it says
  const char* head;  ///< of the page's column, in the notation of page::marked; null: none
  const char* unit;  ///< on the page
  double factor;     ///< from that of live.csv to the page's
  int digits;        ///< on the page
  /// NaN: not known, or not there (no steps, driven wall, grains or reference).
  double (*of)(const Trajectory& trajectory, const LiveComparison& comparison);
};
std::span<const LiveNumber> live_numbers();

/// One row for each trajectory.
std::string live_csv(const LiveComparison& comparison);

/// A line for every trajectory; last, error against cost with a line for every backend. Figures of
/// the wall only with a driven wall, distances only with a reference. A figure of which nothing is
/// known has no panels.
std::vector<page::Picture> live_figures(const LiveComparison& comparison);

/// Reads manifest.json of `folder`; writes live.csv, trajectories as
/// steps-<label>.csv, figures/*.svg and live.html there. Throws Error.
void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison);

/// The k-th backend's line: eight colours, then the same dashed, then thin.
Curve backend_curve(size_t k, const std::string& title);

}  // namespace ballast
