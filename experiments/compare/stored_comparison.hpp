#pragma once
// A comparison that is done, read back from its folder: its rows, and who made them where and when.

#include <filesystem>
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

}  // namespace ballast
