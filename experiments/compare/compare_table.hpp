#pragma once
// Rows -> what tables and figures are made of: medians over repeats, profiles, means, backends side
// by side.

#include <limits>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_row.hpp"

namespace ballast {

/// Time or error of what was not reached.
inline constexpr double not_reached = std::numeric_limits<double>::infinity();

/// One case by one solver to one tolerance, over its repeats.
struct CompareCell {
  const CompareRow* row =
      nullptr;  ///< of the fastest repeat that solved it, else of the first; null: not tried
  bool solved = false;          ///< in every repeat
  double median = not_reached;  ///< prepare and solve [s]; infinite when not solved
  double spread = 0.0;          ///< (slowest - fastest)/median over repeats
};

/// Per case and solver.
using CompareCosts = std::vector<std::vector<double>>;

/// All cells of one start and tolerance.
struct CompareTable {
  StartKind start = StartKind::cold;
  double tolerance = 0.0;
  std::vector<std::string> cases, solvers;      ///< in the order of the rows
  std::vector<std::vector<CompareCell>> cells;  ///< [case][solver]

  const CaseFacts& facts(size_t case_index) const;
  /// Of all solvers, the median over repeats; infinite when none solved it.
  double fastest(size_t case_index) const;
  /// Over the fastest solver's time: Dolan and More's unit of cost. Infinite when not solved.
  CompareCosts time_ratios() const;
  /// Time per contact, for More and Wild's unit of cost [s].
  CompareCosts times_per_contact() const;
  std::string heading() const;  ///< "Tolerance 0.01, cold start"
};

/// One table for each start and tolerance among the rows; loosest tolerance first. Unreadable cases
/// are in none. `rows` must outlive them.
std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows);

/// The cases that all backends of the table tried: where some did not, profiles of all cases would
/// count them as failures.
CompareTable tried_by_all(const CompareTable& table);

/// exp(mean(log(x + shift))) - shift. NaN for no values.
double shifted_geometric_mean(std::span<const double> values, double shift);
/// exp(mean(log((a + shift)/(b + shift)))): how a compares with b case by case.
double shifted_geometric_ratio(std::span<const double> a, std::span<const double> b, double shift);

/// A step curve: from x[k] on the fraction is y[k].
struct StepCurve {
  std::vector<double> x, y;
};

/// The fraction of cases that cost at most x, from `first` to `last`: one curve per solver (Dolan
/// and More 2002, More and Wild 2009). Cases that nobody solves count in the denominator.
std::vector<StepCurve> cost_profiles(const CompareCosts& costs, double first, double last);

/// Error of a history as what was reached by then: falling steps. Times include `prepare_seconds`.
StepCurve best_so_far(const CompareRow& row);

/// Shifts of the geometric means [s]: the smaller, the more the tiny problems count.
inline constexpr double mean_shifts[] = {1e-5, 1e-4, 1e-3};
/// Of the means in a BackendSummary [s].
inline constexpr double summary_shift = 1e-3;

/// One backend in a table of one tolerance and start.
struct BackendSummary {
  std::string solver, law;
  int solved = 0, unsolved = 0, timeouts = 0, crashes = 0, unsupported = 0, no_solutions = 0,
      denied = 0;
  double mean_seconds = 0.0;    ///< shifted geometric mean over all cases (summary_shift); the
                                ///< `unsolved` ones in it count with the limit
  double mean_ratio = 0.0;      ///< the same of time over the fastest backend's, over cases that
                                ///< somebody solved
  double largest_spread = 0.0;  ///< CompareCell::spread
};
/// Sorted: most solved first, then fastest. `limit`: seconds that an unsolved case counts.
std::vector<BackendSummary> backend_summaries(const CompareTable& table, double limit);

/// What an unsolved case counts: the largest limit of the rows.
double limit_of(std::span<const CompareRow> rows);

}  // namespace ballast
