#pragma once
// Comparisons that are done, read back from their folders: rows, and who made them where and when;
// and several of them as one.

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

/// Several comparisons as one.
struct MergedComparison {
  std::vector<std::string> machines;  ///< in the order of their first comparison
  std::vector<CompareRow> rows;       ///< one machine after the other
};

/// Of each solve on a machine the newest comparison's rows count, all its repeats; a solve is known
/// by its identity. A problem has the name that it has in the first comparison, with a number where
/// another one is called so. Of several machines, a case is a problem on one of them ("M2 ·
/// Capsules.dat"), so that a time is only ever divided by another of the same machine. Unreadable
/// cases are left out. Throws Error: rows of two measures.
MergedComparison merged(std::vector<StoredComparison> comparisons);

/// Writes results.csv, manifest.json with who made what, and compare.html of all rows; returns
/// their number. `command`: how it was called, for the manifest. Throws Error: no rows, as
/// merged().
size_t write_merged(const std::filesystem::path& folder,
                    const std::vector<StoredComparison>& comparisons, const std::string& command);

}  // namespace ballast
