#pragma once
// The order of backends by time over many problems, and how sure it is over other problems of the
// same kind (bootstrap).

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
  std::vector<const CompareRow*> cases;  ///< a row of each, sorted by name
  /// Cases x solvers: log(time + shift), the time [s] of the median repeat; the limit where it is
  /// not solved.
  Eigen::MatrixXd log_seconds;
};

/// One for each start and tolerance, loosest tolerance first. The rows must outlive it; unreadable
/// ones count for nothing.
std::vector<TriedCases> tried_cases(std::span<const CompareRow> rows, double shift = summary_shift);

/// The family without a captured case's phase: "shaken, active" -> "shaken".
std::string world_of(const CompareRow& row);

/// What cases of one run have in common: "shaken/25-1-step_0000050" -> "shaken/25-1-". They are
/// alike, so the bootstrap draws runs, not cases.
std::string run_of(const std::string& case_name);

/// A number, and 95 % of the bootstrap's: NaN with fewer than `fewest_runs` runs.
struct Estimate {
  double value, low, high;
};
inline constexpr int fewest_runs = 5, resamples = 200;

/// The rank of each backend by its mean over `members`, rows of log_seconds: 1 for the fastest;
/// equal ones share their mean rank. No members: NaN. The draws are seeded: the same on every
/// machine.
std::vector<Estimate> ranks_of(const TriedCases& tried, const std::vector<Eigen::Index>& members);

/// The public table of a collection's comparison (ranking_page.cpp), into `folder`, whose
/// manifest.json says who made the rows:
///   index.html   the order of the backends, the held part apart; each family; how far the order
///                holds; what each backend fails on; the families
///   ranking.md   the same
///   table.csv    a line for each part (open, held), family or size, tolerance, start and backend
/// Throws Error.
void write_ranking(const std::filesystem::path& folder, std::span<const CompareRow> rows);

}  // namespace ballast
