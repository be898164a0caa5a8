#pragma once
// Rows -> what tables and figures are made of: medians over repeats, profiles, means.

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_row.hpp"

namespace ballast {

/// Time or error of what was not reached.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// One case by one solver to one tolerance, over its repeats.
struct CompareCell {
  const CompareRow* row =
      nullptr;  ///< of the fastest repeat that solved it, else of the first; null: not tried
  bool solved = false;  ///< in every repeat
  double median = 0.0, fastest = 0.0,
         slowest = 0.0;  ///< prepare and solve [s]; infinite when not solved
};

/// All cells of one start and tolerance.
struct CompareTable {
  StartKind start = StartKind::cold;
  double tolerance = 0.0;
  std::vector<std::string> cases, solvers;      ///< in the order of the rows
  std::vector<std::vector<CompareCell>> cells;  ///< [case][solver]

  /// Median times [case][solver]; infinite when not solved.
  std::vector<std::vector<double>> times() const;
  double fastest(size_t case_index)
      const;  ///< of all solvers, median over repeats; infinite when none solved it
};

/// One table for each start and tolerance among the rows; loosest tolerance first. Unreadable cases
/// are in none. `rows` must outlive them.
std::vector<CompareTable> compare_tables(std::span<const CompareRow> rows);

/// exp(mean(log(x + shift))) - shift. NaN for no values.
double shifted_geometric_mean(std::span<const double> values, double shift);
/// exp(mean(log((a + shift)/(b + shift)))): how a compares with b case by case.
double shifted_geometric_ratio(std::span<const double> a, std::span<const double> b, double shift);

/// A step curve: from x[k] on the fraction is y[k].
struct StepCurve {
  std::vector<double> x, y;
};

/// Dolan and More 2002: the fraction of cases that a solver solves within x times the fastest
/// solver's time. One curve per solver, from x = 1 to `last`. Cases that nobody solves count in the
/// denominator.
std::vector<StepCurve> performance_profiles(const std::vector<std::vector<double>>& times,
                                            double last);

/// More and Wild 2009, with time per contact for their unit of cost: the fraction of cases solved
/// within x. `sizes`: per case. From `first` to `last`.
std::vector<StepCurve> data_profiles(const std::vector<std::vector<double>>& times,
                                     std::span<const double> sizes, double first, double last);

/// Error of a history as what was reached by then: falling steps. Times include `prepare_seconds`.
StepCurve best_so_far(const CompareRow& row);

/// Geometric mean over the curves of the error at each of `times`; before a curve's first point its
/// first error holds; zero counts as 1e-16. NaN without curves.
std::vector<double> mean_error_at(std::span<const StepCurve> curves, std::span<const double> times);

}  // namespace ballast
