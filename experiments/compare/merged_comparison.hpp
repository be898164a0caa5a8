#pragma once
// Comparisons of several machines, commits and days as one: which rows count, and what may be said
// of them together.

#include <span>
#include <vector>

#include "experiments/compare/compare_table.hpp"
#include "experiments/compare/stored_comparison.hpp"

namespace ballast {

/// The rows of one machine.
struct MachineRows {
  std::string machine;
  std::vector<size_t> sources;   ///< places in the list of comparisons, oldest first
  std::vector<CompareRow> rows;  ///< of each solve the newest comparison's, all its repeats
};

/// One machine after the other, in the order of their first comparison. A solve is known by what
/// the problem holds, backend, tolerance, start and measure; a problem has the name that it has in
/// the first comparison, with a number where another one is called so. Unreadable cases are left
/// out.
std::vector<MachineRows> merged_machines(std::span<const StoredComparison> comparisons);

/// All machines' rows for what is said as ratios alone: a case is a problem on a machine ("M2 ·
/// Capsules.dat"), so that a time is only ever divided by another of the same machine. Rows of one
/// measure, which must be that of all. Throws Error naming both where there are two.
std::vector<CompareRow> pooled_rows(std::span<const MachineRows> machines);

/// The cases that all backends of the table tried: where some did not, profiles of all cases would
/// count them as failures.
CompareTable tried_by_all(const CompareTable& table);

}  // namespace ballast
