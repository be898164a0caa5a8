#pragma once
// A comparison for a cluster: its cases and backends as jobs of Snakemake.

#include <filesystem>
#include <string>
#include <vector>

namespace ballast {

/// `cases`: words of the command line; `external`: those of programs that solve; `options`: all
/// others but the backends and the folder; `finish`: those of the last job alone.
struct ComparisonPlan {
  std::vector<std::string> cases, solvers, external, options, finish;
  std::filesystem::path results;
};

/// Writes Snakefile, jobs.json and slurm/ into `folder`: one job for each word and backend, and
/// one for each word and all programs, which leave their rows in the results' folder, and a last
/// one that finds all rows there and draws the page. Jobs begin in this process' folder, where the
/// programs' commands are meant. Throws Error.
void write_compare_snakemake(const ComparisonPlan& plan, const std::filesystem::path& folder);

}  // namespace ballast
