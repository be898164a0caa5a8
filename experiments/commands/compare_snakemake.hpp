#pragma once
// A comparison for a cluster: its cases and backends as jobs of Snakemake.

#include <filesystem>
#include <string>
#include <vector>

namespace ballast {

/// `cases`: words of the command line; `options`: all others but the backends and the folder.
struct ComparisonPlan {
  std::vector<std::string> cases, solvers, options;
  std::filesystem::path results;
};

/// Writes Snakefile, jobs.json and slurm/ into `folder`: one job for each word and backend, which
/// leaves its rows in the results' folder, and a last one that finds all rows there and draws the
/// page. Throws Error.
void write_compare_snakemake(const ComparisonPlan& plan, const std::filesystem::path& folder);

}  // namespace ballast
