#pragma once
// A comparison that is done, read back from its folder: its rows, and who made them where and when.

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "experiments/compare/compare_row.hpp"

namespace ballast {

struct StoredComparison {
  std::filesystem::path folder;
  std::string machine;  ///< processor and number of cores: times of two machines make no ratio
  std::string program;  ///< commit, "-dirty" behind it when it was not quite that
  std::string started;  ///< UTC, "2026-11-22T09:30:00Z"
  std::vector<CompareRow> rows;  ///< sorted by case, solver, tolerance, start, repeat
};

/// What makes two rows the same solve, whoever made them: what the problem holds, not its name;
/// backend, tolerance, start, measure.
using SolveIdentity = std::tuple<std::string, std::string, double, StartKind, Measure>;
SolveIdentity identity_of(const CompareRow& row);

/// Reads `folder`/manifest.json and `folder`/rows. Throws Error: there are none, a damaged row.
StoredComparison read_comparison(const std::filesystem::path& folder);

}  // namespace ballast
