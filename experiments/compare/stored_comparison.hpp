#pragma once
// Comparisons that are done, read back from their folders: rows, and who made them where and when;
// and several of them as one.

#include <filesystem>
#include <span>
#include <string>
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

/// Reads `folder`/manifest.json and `folder`/rows. Throws Error: there are none, a damaged row.
StoredComparison read_comparison(const std::filesystem::path& folder);

/// Several comparisons as one.
struct MergedComparison {
  std::vector<std::string> machines;  ///< in the order of their first comparison
  std::vector<CompareRow> rows;       ///< one machine after the other
};

/// Two rows are the same solve, whoever made them, by what the problem holds, not its name, by
/// backend, tolerance, start and measure. Of each solve on a machine the newest comparison's rows
/// count, all its repeats. A problem has the name that it has in the first comparison, with a
/// number where another one is called so. Of several machines, a case is a problem on one of them
/// ("M2 · Capsules.dat"), so that a time is only ever divided by another of the same machine.
/// Unreadable cases are left out. Throws Error: rows of two measures.
MergedComparison merged(std::vector<StoredComparison> comparisons);

/// Makes the folder and writes manifest.json, with who made what; returns all rows. `command`: how
/// it was called, for the manifest. Throws Error: no rows, as merged().
std::vector<CompareRow> write_origins(const std::filesystem::path& folder,
                                      const std::vector<StoredComparison>& comparisons,
                                      const std::string& command);

/// results.csv and compare.html of all rows.
void write_merged(const std::filesystem::path& folder, std::span<const CompareRow> rows);

// Two comparisons of the same cases, before and after a change: what has become of each solve.

enum class Change { same, faster, slower, lost, gained, only_before, only_after };

const char* name_of(Change change);

struct ChangedSolve {
  const CompareRow* row;  ///< of before, or of after alone
  Change change = Change::same;
  double before = 0.0, after = 0.0;  ///< median of the repeats [s]; 0: not all are solved
  double spread = 1.0;  ///< how far the repeats of one side are apart, as a factor; the larger one
};

/// Pairs rows as merged() does. A solve is faster or slower when its
/// median changed by more than the factor `least` and by more than its own spread; with `least`
/// infinite times are not compared. It is `lost` when it was solved in every repeat before and is
/// not now. What matters comes first: lost, slower, then the rest by name.
std::vector<ChangedSolve> compare_diff(std::span<const CompareRow> before,
                                       std::span<const CompareRow> after, double least);

}  // namespace ballast
