#pragma once
// One finished run as a row: everything that is set and measured of it, in SI units. A report's
// data/runs.csv is their table, and whatever compares runs sample by sample reads it.

#include <cmath>
#include <filesystem>
#include <functional>
#include <type_traits>

#include "experiments/measure/run_summary.hpp"

namespace ballast {

struct RunRow {
  std::string name, stage;  ///< of the campaign
  std::string key;          ///< of the resolved scene: the folder of the record
  std::string record;  ///< hash of the record's steps without wall clock: equal runs, equal hash
  RunSummary run;
};

/// A number of the row, or what follows from such numbers. NaN: not known in this run.
struct RunColumn {
  const char* name;  ///< snake_case
  const char* unit;  ///< "1" without one
  const char* meaning;
  double (*value)(const RunSummary& run);
  void (*set)(RunSummary& run, double value) = nullptr;  ///< null: follows from other columns

  /// `Get`: [](auto& run) that returns where the number stands, or [](const RunSummary& run) that
  /// computes it.
  template <class Get>
  constexpr RunColumn(const char* its_name, const char* its_unit, const char* its_meaning, Get)
      : name(its_name), unit(its_unit), meaning(its_meaning) {
    if constexpr (std::is_invocable_r_v<double, Get, const RunSummary&>) {
      value = [](const RunSummary& run) { return Get{}(run); };
    } else {
      value = [](const RunSummary& run) { return static_cast<double>(*Get{}(run)); };
      set = [](RunSummary& run, double to) {
        auto& place = *Get{}(run);
        using Number = std::remove_reference_t<decltype(place)>;
        constexpr double most = 1e9;  // of counts, which a foreign file may have without bounds
        place = static_cast<Number>(
            std::is_integral_v<Number> ? std::fmin(std::fmax(to, -most), most) : to);
      };
    }
  }
};
/// The columns of runs.csv after the texts name, stage, key, record, solver.
std::span<const RunColumn> run_columns();

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
