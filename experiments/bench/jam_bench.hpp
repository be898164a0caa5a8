#pragma once
// `ballast bench jam`: how stiff the jams of a run are under other solvers, iterations and steps,
// and how fast the wall creeps in them under a steady load.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/bench/measurement.hpp"
#include "experiments/measure/static_load.hpp"

namespace ballast {

struct JamOptions {
  std::vector<std::string> solvers;
  std::vector<int> iterations;  ///< in every step; the tolerance is 0
  std::vector<double> steps;    ///< h [s]
  int states = 2;               ///< so many jams, of those with the largest load
  double part = 0.1, settle = 0.04, seconds = 0.01;  ///< StaticLoadSettings
};

/// One state under one setting.
struct JamRow {
  double time = 0.0, force = 0.0;  ///< of the state [s], [N]
  int grains = 0;
  std::string solver;
  int iterations = 0;
  double h = 0.0;      ///< [s]
  double scale = 1.0;  ///< g h [m/s]
  StaticLoad found;

  double stiffness() const { return 1.0 / found.compliance; }  ///< k_art [N/m]
};

/// The stored states of a run (record.state_rate) in which the wall is jammed. `said` hears of each
/// row; returning false stops. Throws Error where the run keeps none, or no scene.
std::vector<JamRow> measure_jams(const std::filesystem::path& run, const JamOptions& options,
                                 const std::function<bool(const JamRow&)>& said);

std::vector<Measurement> jam_measurements(const std::vector<JamRow>& rows);
std::string jam_csv(const std::vector<JamRow>& rows);

}  // namespace ballast
