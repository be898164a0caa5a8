#pragma once
// One finished run as a row of numbers: everything that is set and measured of it, in SI units. A
// report's data/runs.csv is their table, and whatever compares runs sample by sample reads it.

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/measure/run_summary.hpp"

namespace ballast {

/// A number of a run. NaN: not known in this run.
struct RunColumn {
  const char* name;  ///< snake_case
  const char* unit;  ///< "1" without one
  const char* meaning;
  double (*value)(const RunSummary& run);
};
/// The columns of runs.csv after the texts name, stage, key, record, solver.
std::span<const RunColumn> run_columns();

struct RunRow {
  std::string name, stage;  ///< of the campaign
  std::string key;          ///< of the resolved scene: the folder of the record
  std::string record;  ///< hash of the record's steps without wall clock: equal runs, equal hash
  std::string solver;
  std::vector<double> numbers;  ///< as run_columns()

  /// Nothing is known yet.
  RunRow();
  explicit RunRow(const RunSummary& run);
  /// The number of a column; there must be one of this name (std::invalid_argument).
  double operator[](std::string_view column) const { return numbers[place_of(column)]; }
  double& operator[](std::string_view column) { return numbers[place_of(column)]; }

 private:
  static size_t place_of(std::string_view column);
};

/// Names, then units, then one row a run.
std::string runs_csv(std::span<const RunRow> rows);
/// Reads such a table, of this or an earlier version: what a column means that is not known here is
/// left out, and a column that is not in it is not known. Throws Error naming file, line and
/// column where it is none.
std::vector<RunRow> read_runs_csv(const std::filesystem::path& file);
/// The columns and what they mean, as CSV: column, unit, description.
std::string run_columns_csv();

/// Of all columns of the steps but wall clock, to the last bit.
std::string record_hash(std::span<const StepRecord> steps);

}  // namespace ballast
