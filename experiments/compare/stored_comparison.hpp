#pragma once
// Finished comparisons, read back from their folders with their origins, and several as one.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "experiments/compare/compare_row.hpp"

namespace ballast {

struct StoredComparison {
  std::filesystem::path folder;
  std::string machine;  ///< processor and number of cores; only times of one machine form ratios
  std::string program;  ///< commit, with "-dirty" where the sources were modified
  std::string started;  ///< UTC, "2026-11-22T09:30:00Z"
  std::vector<CompareRow> rows;  ///< sorted by case, solver, tolerance, start, repeat
};

/// Reads `folder`: manifest.json, results.csv, rows/. Throws Error where one is missing or damaged.
StoredComparison read_comparison(const std::filesystem::path& folder);

struct MergedComparison {
  std::vector<std::string> machines;  ///< in the order of their first comparison
  std::vector<CompareRow> rows;       ///< one machine after the other
};

/// Rows are the same solve if the problem's content (not its name), backend, tolerance, start and
/// measure agree. For each solve on a machine all repeats of the newest comparison count. A problem
/// keeps its name of the first comparison, numbered if another one has it. With several machines, a
/// case is a problem on one of them ("M2 · Capsules.dat"), so that times of two machines are never
/// divided. Unreadable cases are left out. Throws Error for rows of two measures.
MergedComparison merged(std::vector<StoredComparison> comparisons);

/// Makes the folder, writes manifest.json with each comparison's origin, and returns all rows.
/// `command` is the command line, for the manifest. Throws Error as merged() does, or without rows.
std::vector<CompareRow> write_origins(const std::filesystem::path& folder,
                                      const std::vector<StoredComparison>& comparisons,
                                      const std::string& command);

/// Writes results.csv and compare.html of all rows.
void write_merged(const std::filesystem::path& folder, std::span<const CompareRow> rows);

// Two comparisons of the same cases, before and after a change: the change of each solve.

enum class Change { same, faster, slower, lost, gained, only_before, only_after };

const char* name_of(Change change);

struct ChangedSolve {
  const CompareRow* row;  ///< from before, or else from after
  Change change = Change::same;
  double before = 0.0, after = 0.0;  ///< median of the repeats [s]; 0: not all are solved
  double spread = 1.0;  ///< slowest over fastest repeat of a side; the larger of the two
};

/// Pairs rows as merged() does. A solve is faster or slower when its median changed by more than
/// the factor `least` and by more than its own spread; an infinite `least` compares no times. It is
/// `lost` when it was solved in every repeat before and is not after. Lost solves come first, then
/// slower ones, then the rest; each group is sorted by name.
std::vector<ChangedSolve> compare_diff(std::span<const CompareRow> before,
                                       std::span<const CompareRow> after, double least);

}  // namespace ballast
