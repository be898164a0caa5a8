#pragma once
// Comparisons that are done, read back from their folders: rows, and who made them where and when;
// and several of them as one: which rows count, and what may be said of them together.

#include <filesystem>
#include <span>
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

/// The rows of one machine.
struct MachineRows {
  std::string machine;
  std::vector<size_t> sources;   ///< places in the list of comparisons, oldest first
  std::vector<CompareRow> rows;  ///< of each solve the newest comparison's, all its repeats
};

/// One machine after the other, in the order of their first comparison. A solve is known by its
/// identity; a problem has the name that it has in the first comparison, with a number where
/// another one is called so. Unreadable cases are left out.
std::vector<MachineRows> merged_machines(std::span<const StoredComparison> comparisons);

/// All machines' rows for what is said as ratios alone: a case is a problem on a machine ("M2 ·
/// Capsules.dat"), so that a time is only ever divided by another of the same machine. Rows of one
/// measure, which must be that of all. Throws Error naming both where there are two.
std::vector<CompareRow> pooled_rows(std::span<const MachineRows> machines);

}  // namespace ballast
