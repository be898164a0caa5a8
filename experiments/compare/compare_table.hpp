#pragma once
// Rows -> backends side by side: medians over repeats, means over cases. What the reader of the
// page chooses of them is computed there (answers/statistics.js).

#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_row.hpp"

namespace ballast {

/// One backend to one tolerance from one start, over all cases that it tried. A case is solved when
/// every repeat is; its time is the median over them.
struct BackendSummary {
  std::string solver, law;
  int solved = 0, unsolved = 0, timeouts = 0, crashes = 0, unsupported = 0, no_solutions = 0,
      denied = 0;
  double mean_seconds = 0.0;    ///< shifted geometric mean over all cases (summary_shift); the
                                ///< `unsolved` ones in it count with the limit
  double mean_ratio = 0.0;      ///< the same of time over the fastest backend's, over cases that
                                ///< somebody solved; NaN: none
  double largest_spread = 0.0;  ///< (slowest - fastest)/median over the repeats of a solved case
};

/// All backends of one start and tolerance: most solved first, then fastest.
struct CompareTable {
  std::string heading;  ///< "Tolerance 0.01, cold start"
  size_t cases = 0;
  std::vector<BackendSummary> backends;
};

/// Shift of the geometric means [s]: the smaller, the more the tiny problems count.
inline constexpr double summary_shift = 1e-3;

/// One table for each start and tolerance among the rows; loosest tolerance first. Unreadable cases
/// are in none.
std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows);

/// What an unsolved case counts: the largest limit of the rows.
double limit_of(std::span<const CompareRow> rows);

}  // namespace ballast
