#pragma once
// What `ballast bench` measures: named samples with their unit, kept as JSON with the machine and
// the commit.

#include <filesystem>
#include <string>
#include <vector>

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

}  // namespace ballast
