#pragma once
// One finished run of the campaign in numbers: what was set, and everything that is measured of it.
// Whatever compares runs sample by sample starts here: PaperData::observables() has one of these
// for each finished run, and `data/runs.csv` of the report is their table, in run_columns().
//
// Each measure is defined in its own header of experiments/measure. NaN: not known in this run (too
// short, nothing stored).

#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "experiments/measure/observables.hpp"
#include "experiments/measure/packing_density.hpp"
#include "experiments/measure/roll.hpp"

namespace ballast {

/// How the solid fraction moves within a period: means over the periods that count.
struct PhaseGains {
  double extension = not_known;    ///< from where the stroke begins to its peak
  double contraction = not_known;  ///< from the peak to the period's end
};

/// What was set and stands in no RunFacts.
struct RunSetup {
  int seed = 0;
  std::string solver;
  double iterations_most = not_known;  ///< of the solver per step
  double tolerance = not_known;        ///< of the solver [g h]
  double grains = not_known;
  double length = not_known, width = not_known;  ///< of the box: L, W [m]
  double height = not_known;        ///< H: top of the packing before the lid is raised [m]
  double lid_raise = not_known;     ///< [m]
  double largest_size = not_known;  ///< largest distance of a grain's centre to a vertex [m]
  double friction = not_known, deposit_friction = not_known;
  double lid_pressure = not_known;  ///< grain weights while depositing; 0: placed
  double start_noise = not_known;   ///< [m]
};

struct RunObservables {
  size_t run = 0;           ///< index into Campaign::runs
  std::string name, stage;  ///< of the campaign
  std::string key;          ///< of the resolved scene: the folder of the record
  std::string record;  ///< hash of the record's steps without wall clock: equal runs, equal hash
  RunSetup setup;
  Observation seen;       ///< over all periods that count; seen.facts: h, g, nu, f_max, m, m_w
  Statistics iterations;  ///< per step
  ForceLaw law;           ///< f_g(xi) and f_g(f) while the wall moves
  JammedState jam;
  PhaseGains gains;              ///< of the control volume, every step
  double speed_out = not_known;  ///< largest outward velocity [m/s]
  // from stored poses
  SolidFractions before;                          ///< at t = 0
  SolidFractions after;                           ///< at t = 0.2 s, where a pose is stored then
  std::array<PhaseGains, density_layers> layers;  ///< lowest first; runs with 100 poses a second
  Roll roll;  ///< mean displacement of a period around the box's middle half

  double x_scale() const { return seen.eq3(); }  ///< X: right side of Eq. 3 without C [m]
  double prefactor() const { return seen.rise / seen.eq3(); }    ///< C = Delta x_max / X
  double aspect() const { return setup.length / setup.height; }  ///< L/H
  double force_over_weight() const;                              ///< f_max/(m g)
  double wall_mass_over_grains() const;                          ///< m_w/m
};

/// The columns of runs.csv, SI units, after the texts name, stage, key, record, solver. A column is
/// a number of the row, or follows from such numbers.
struct RunColumn {
  const char* name;  ///< snake_case
  const char* unit;  ///< "1" without one
  const char* description;
  double (*value)(const RunObservables& run);
  void (*set)(RunObservables& run, double value) = nullptr;  ///< null: follows from other columns

  /// `Get`: [](auto& run) that returns where the number stands, or [](const RunObservables& run)
  /// that computes it.
  template <class Get>
  constexpr RunColumn(const char* its_name, const char* its_unit, const char* its_description, Get)
      : name(its_name), unit(its_unit), description(its_description) {
    if constexpr (std::is_invocable_r_v<double, Get, const RunObservables&>) {
      value = [](const RunObservables& run) { return Get{}(run); };
    } else {
      value = [](const RunObservables& run) { return static_cast<double>(*Get{}(run)); };
      set = [](RunObservables& run, double to) {
        auto& place = *Get{}(run);
        using Number = std::remove_reference_t<decltype(place)>;
        constexpr double most = 1e9;  // of counts, which a foreign file may have without bounds
        place = static_cast<Number>(
            std::is_integral_v<Number> ? std::fmin(std::fmax(to, -most), most) : to);
      };
    }
  }
};
std::span<const RunColumn> run_columns();

/// Names, then units, then one row a run.
std::string runs_csv(std::span<const RunObservables> runs);
/// Reads such a table, of this or an earlier version: a column that is not in it is not known.
/// Throws Error naming file, line and column where it is none.
std::vector<RunObservables> read_runs_csv(const std::filesystem::path& file);
/// The columns and what they mean, as CSV: column, unit, description.
std::string run_columns_csv();

/// The grains of a run, from its manifest's summary.
double grain_count(const RunData& data);

/// Of all columns of the steps but wall clock, to the last bit.
std::string record_hash(std::span<const StepRecord> steps);

/// Measures a finished run's folder; what the poses say is left out where they cannot be read.
/// Throws Error as read_run_data.
RunObservables observe_run(const RunData& data);

}  // namespace ballast
