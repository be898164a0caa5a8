#pragma once
// Output of a closed-loop comparison: numbers and figures of its trajectories, a page, CSV files.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/live.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// A number that sums up a trajectory: a column of live.csv and, with a head, of the page's table.
struct LiveNumber {
  const char* name;  ///< in live.csv, in SI units, or in ms where it says so
  const char* head;  ///< of the page's column, in the notation of page::marked; null: no column
  const char* unit;  ///< on the page
  double factor;     ///< from the unit in live.csv to that on the page
  int digits;        ///< on the page
  /// Returns NaN where it is not known or does not exist (no steps, wall, grains or reference).
  double (*of)(const Trajectory& trajectory, const LiveComparison& comparison);
};
std::span<const LiveNumber> live_numbers();

/// One row for each trajectory.
std::string live_csv(const LiveComparison& comparison);

/// Figures with a line for every trajectory; the last one is error against cost, with a line for
/// every backend. Figures of the wall need a driven wall, distances need a reference. A figure
/// without known values has no panels.
std::vector<page::Picture> live_figures(const LiveComparison& comparison);

/// Reads manifest.json of `folder`; writes live.csv, trajectories as steps-<label>.csv,
/// figures/*.svg and live.html there. Throws Error.
void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison);

/// The k-th backend's line: eight colours, then the same dashed, then thin.
Curve backend_curve(size_t k, const std::string& title);

}  // namespace ballast
