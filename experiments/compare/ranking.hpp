#pragma once
// The order of backends by time, and how certain it is for similar problems (bootstrap).

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include "experiments/compare/compare_page.hpp"

namespace ballast {

/// Backends of one start and tolerance on the cases that all of them tried.
struct TriedCases {
  StartKind start = StartKind::cold;
  double tolerance = 0.0;
  std::vector<std::string> solvers;      ///< sorted
  std::vector<const CompareRow*> cases;  ///< one row of each case, sorted by name
  /// Cases x solvers: log(time + shift), where time is the median over repeats [s], or the limit
  /// where the case is not solved.
  Eigen::MatrixXd log_seconds;
};

/// One for each start and tolerance, loosest first, of the readable rows, which must outlive it.
std::vector<TriedCases> tried_cases(std::span<const CompareRow> rows, double shift = summary_shift);

/// The family without a captured case's phase: "shaken, active" -> "shaken".
std::string base_family(const CompareRow& row);

/// The part of its name that a case shares with all cases of its run: "shaken/25-1-step_0000050" ->
/// "shaken/25-1-". Cases of one run are alike, so the bootstrap draws runs, not cases.
std::string run_of(const std::string& case_name);

/// A number and its 95 % interval by bootstrap, NaN with fewer than `fewest_runs` runs.
struct Estimate {
  double value, low, high;
};
inline constexpr int fewest_runs = 5, resamples = 200;

/// Returns the rank of each backend by its mean over `members`, rows of log_seconds: 1 for the
/// fastest; equal means share their mean rank. Without members all is NaN. The seed is fixed.
std::vector<Estimate> ranks_of(const TriedCases& tried, const std::vector<Eigen::Index>& members);

/// Writes the public table of a collection's comparison into `folder`, whose manifest.json says
/// which program and machine made the rows. Throws Error.
///   index.html   the order of the backends, the held part apart; each family; how far the order
///                holds; what each backend fails on; the families
///   ranking.md   the same page
///   table.csv    a line for each part (open, held), family or size, tolerance, start and backend
void write_ranking(const std::filesystem::path& folder, std::span<const CompareRow> rows);

}  // namespace ballast
