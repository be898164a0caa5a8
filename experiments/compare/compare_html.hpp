#pragma once
// Tables of a comparison's page.

#include <span>

#include "experiments/compare/compare_table.hpp"
#include "experiments/compare/reference_times.hpp"
#include "experiments/page/html_page.hpp"

namespace ballast {

/// Shifts of the geometric means [s]: the smaller, the more the tiny problems count.
inline constexpr double mean_shifts[] = {1e-5, 1e-4, 1e-3};

/// One backend in a table of one tolerance and start.
struct BackendSummary {
  std::string solver, law;
  int solved = 0, timeouts = 0, crashes = 0, unsupported = 0, false_successes = 0;
  double mean_seconds =
      0.0;  ///< shifted geometric mean over all cases (shift 1 ms); unsolved: the limit
  double mean_ratio =
      0.0;  ///< the same of time over the fastest backend's, over cases that somebody solved
  double largest_spread = 0.0;  ///< (slowest - fastest)/median over repeats
};
/// Sorted: most solved first, then fastest. `limit`: seconds that an unsolved case counts.
std::vector<BackendSummary> backend_summaries(const CompareTable& table, double limit);

/// What an unsolved case counts: the largest limit of the rows.
double limit_of(std::span<const CompareRow> rows);

Html backends_html(const CompareTable& table, double limit);
/// Case by case: fastest backend, its time and spread, or how near anybody came; the worst contact
/// by name.
Html cases_html(const CompareTable& table);
/// Claims that the judge denies, crashes and memory: empty when there are none.
Html failures_html(std::span<const CompareRow> rows);
Html reference_html(const ReferenceComparison& comparison, double limit);

}  // namespace ballast
