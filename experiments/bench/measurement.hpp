#pragma once
// What `ballast bench` measures: named samples with their unit, kept as JSON with the machine and
// the commit.

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

/// A file of results: of one kind (kernels, step, scaling), machine and program.
struct BenchResult {
  std::string kind, command, commit, cpu;
  std::vector<Measurement> measurements;
};

/// Writes folder/<kind>.json, beside and renamed. Throws Error.
void write_bench_result(const std::filesystem::path& folder, const std::string& kind,
                        const std::string& command, const std::vector<Measurement>& measurements);

/// A file made by write_bench_result. Throws Error naming the file and what is wrong in it.
BenchResult read_bench_result(const std::filesystem::path& file);

/// What two files have in common as a Markdown table: medians, and b over a. Measurements of one
/// file alone are named below it.
std::string bench_ratio_table(const BenchResult& a, const BenchResult& b);

/// The same measurements as a table for the terminal.
std::string measurement_table(const std::vector<Measurement>& measurements);

/// The page of results (docs/results.md): which commands measure it, and its numbers put into it.
struct BenchAll {
  std::filesystem::path output = "results/bench_all";
  std::filesystem::path page;  ///< of somebody's own, written as results.md; none: the built-in one
  /// Numbers that are kept (numbers.csv): the page is written of them, and nothing is measured.
  std::filesystem::path rows;
  /// A shell's command of another program, whose last word is its milliseconds of a step.
  std::string beside;
};

/// Runs what has no result yet by this program, in `output`, and writes results.md, numbers.csv and
/// the figure of time against error there. The same command goes on after an interrupt. Throws
/// Error: a stage that fails.
ExitCode bench_all(const BenchAll& options);

}  // namespace ballast
