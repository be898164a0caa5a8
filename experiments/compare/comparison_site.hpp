#pragma once
// Merged comparisons as a folder that any web host serves:
//
//   index.html             all machines: who solves what, ratios, profiles, problems
//   rows.csv               every row of every comparison, with machine, program, day
//   machines/M1-<name>/    a comparison folder for each machine: compare.html, results.csv,
//                          rows/, manifest.json; it can be merged and compared again

#include <filesystem>
#include <span>

#include "experiments/compare/stored_comparison.hpp"

namespace ballast {

/// `command`: how it was called, for the manifest. Throws Error.
void write_comparison_site(const std::filesystem::path& folder,
                           std::span<const StoredComparison> comparisons,
                           const std::string& command);

}  // namespace ballast
