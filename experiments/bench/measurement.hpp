#pragma once
// The measurements of `ballast bench`: named samples with their unit, kept as JSON with the machine
// and the commit.

#include <filesystem>
#include <string>
#include <vector>

#include "platform/error.hpp"

namespace ballast {

/// One measured quantity. `median`, `low` and `high` (quartiles) and `mean` of `samples` values.
struct Measurement {
  std::string group, name, unit;
  double median = 0.0, mean = 0.0, low = 0.0, high = 0.0;
  long samples = 0;
  std::string full_name() const { return group + "/" + name; }
};

/// Throws std::invalid_argument when there is no value.
Measurement measurement_of(const std::string& group, const std::string& name,
                           const std::string& unit, std::vector<double> values);

/// A file of results, of one kind (kernels, step, scaling), machine and program.
struct BenchResult {
  std::string kind, command, commit, cpu;
  std::vector<Measurement> measurements;
};

/// Writes folder/<kind>.json, beside the target and renamed. Throws Error.
void write_bench_result(const std::filesystem::path& folder, const std::string& kind,
                        const std::string& command, const std::vector<Measurement>& measurements);

/// Reads a file made by write_bench_result. Throws Error naming the file and what is wrong in it.
BenchResult read_bench_result(const std::filesystem::path& file);

/// The measurements that two files have in common as a Markdown table: medians, and b over a.
/// Measurements of one file alone are named below it.
std::string bench_ratio_table(const BenchResult& a, const BenchResult& b);

/// Measurements as a table for the terminal.
std::string measurement_table(const std::vector<Measurement>& measurements);

/// The page of results (docs/results.md): the options for measuring its numbers.
struct BenchAll {
  std::filesystem::path output = "results/bench_all";
  std::filesystem::path page;  ///< the user's own, written as results.md; empty: the built-in one
  /// A file of kept numbers (numbers.csv): the page is made from them, and nothing is measured.
  std::filesystem::path rows;
  /// A shell command of another program; the last word that it prints is its milliseconds per step.
  std::string beside;
  std::filesystem::path caller = std::filesystem::current_path();  ///< where `beside` runs
};

/// Runs in `output` the stages that have no result by this program yet, and writes results.md,
/// numbers.csv and the figure of time against error there. The same command goes on after an
/// interrupt. Throws Error: a stage that fails.
ExitCode bench_all(const BenchAll& options);

}  // namespace ballast
