#pragma once
// Backends side by side on all cases of one tolerance and start: what the page's first table and
// the terminal show.

#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_table.hpp"
#include "experiments/compare/reference_times.hpp"

namespace ballast {

/// Shifts of the geometric means [s]: the smaller, the more the tiny problems count.
inline constexpr double mean_shifts[] = {1e-5, 1e-4, 1e-3};

/// Of the means in a BackendSummary [s].
inline constexpr double summary_shift = 1e-3;

/// One backend in a table of one tolerance and start.
struct BackendSummary {
  std::string solver, law;
  int solved = 0, unsolved = 0, timeouts = 0, crashes = 0, unsupported = 0, no_solutions = 0,
      false_successes = 0;
  double mean_seconds = 0.0;  ///< shifted geometric mean over all cases (summary_shift); the
                              ///< `unsolved` ones in it count with the limit
  double mean_ratio =
      0.0;  ///< the same of time over the fastest backend's, over cases that somebody solved
  double largest_spread = 0.0;  ///< (slowest - fastest)/median over repeats
};
/// Sorted: most solved first, then fastest. `limit`: seconds that an unsolved case counts.
std::vector<BackendSummary> backend_summaries(const CompareTable& table, double limit);

/// What an unsolved case counts: the largest limit of the rows.
double limit_of(std::span<const CompareRow> rows);

/// "Tolerance 0.01, cold start"
std::string heading_of(const CompareTable& table);

/// The table of backends as text for a terminal, and the ratios to the reference.
std::string compare_summary(std::span<const CompareRow> rows,
                            std::span<const ReferenceTimes> reference);

}  // namespace ballast
