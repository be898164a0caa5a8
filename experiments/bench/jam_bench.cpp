#include "experiments/bench/jam_bench.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/measure/run_data.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/run/prepared_run.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

struct JamState {
  Checkpoint at;
  double force = 0.0;  ///< [N]
};

/// Those with the largest load, the largest first.
std::vector<JamState> jams_of(const RunData& data, int most) {
  const WallCycles wall = summarise(data.steps, data.facts).wall;
  std::vector<JamState> jams;
  for (const std::filesystem::path& file : RunFolder(data.folder).state_files()) {
    Checkpoint at = read_checkpoint(file);
    const auto row = static_cast<size_t>(at.state.step - 1);  // row k of the record is step k + 1
    if (row >= wall.phase.size() || wall.phase[row] != WallPhase::jammed) continue;
    jams.push_back({std::move(at), data.steps[row].load});
  }
  std::stable_sort(jams.begin(), jams.end(),
                   [](const JamState& a, const JamState& b) { return a.force > b.force; });
  if (jams.size() > static_cast<size_t>(most)) jams.resize(static_cast<size_t>(most));
  return jams;
}

struct RowNumber {
  const char *name, *unit;
  double (*of)(const JamRow&);
};
constexpr RowNumber row_numbers[] = {
    {"k_art", "N/m", [](const JamRow& r) { return r.stiffness(); }},
    {"compliance", "m/N", [](const JamRow& r) { return r.found.compliance; }},
    {"creep of the wall, outward", "g h", [](const JamRow& r) { return r.found.creep / r.scale; }},
    {"speed of the wall", "g h", [](const JamRow& r) { return r.found.speed / r.scale; }},
    {"error rms over contacts", "g h", [](const JamRow& r) { return r.found.error / r.scale; }},
    {"iterations", "a step", [](const JamRow& r) { return r.found.iterations; }}};

}  // namespace

std::vector<JamRow> measure_jams(const std::filesystem::path& run, const JamOptions& options,
                                 const std::function<bool(const JamRow&)>& said) {
  const RunData data = read_run_data(run);
  if (!data.scene) throw Error(run.string() + ": no scene.toml that can be read");
  const std::vector<JamState> jams = jams_of(data, options.states);
  if (jams.empty())
    throw Error(run.string() + ": keeps no state in which the wall is jammed (record.state_rate)");
  MotionState unused;
  const MechanicalSystem system = system_of_run(run, unused);
  std::vector<JamRow> rows;
  for (const JamState& jam : jams)
    for (const std::string& solver : options.solvers)
      for (const double h : options.steps)
        for (const int iterations : options.iterations) {
          // The run's scene with another solver and step; every step takes all iterations.
          Scene scene = *data.scene;
          scene.step = h;
          scene.solver.name = solver;
          scene.solver.tolerance = 0.0;
          scene.solver.max_iterations = iterations;
          const StepSettings settings = step_settings(scene);
          rows.push_back({jam.at.state.time, jam.force, system.grain_count, solver, iterations, h,
                          settings.velocity_scale(),
                          static_load(system, settings, jam.at.state, jam.at.memory,
                                      {jam.force, options.part, options.settle, options.seconds})});
          if (!said(rows.back())) return rows;
        }
  return rows;
}

std::vector<Measurement> jam_measurements(const std::vector<JamRow>& rows) {
  std::vector<Measurement> measurements;
  std::vector<std::string> groups;
  const auto group_of = [](const JamRow& r) {
    return printed("%s, %d iterations, h %g s", r.solver.c_str(), r.iterations, r.h);
  };
  for (const JamRow& row : rows)
    if (std::find(groups.begin(), groups.end(), group_of(row)) == groups.end())
      groups.push_back(group_of(row));
  for (const std::string& group : groups)
    for (const RowNumber& number : row_numbers) {
      std::vector<double> values;
      for (const JamRow& row : rows)
        if (group_of(row) == group) values.push_back(number.of(row));
      measurements.push_back(measurement_of(group, number.name, number.unit, std::move(values)));
    }
  return measurements;
}

std::string jam_csv(const std::vector<JamRow>& rows) {
  CsvWriter csv;
  for (const char* name :
       {"time [s]", "force [N]", "grains", "solver", "iterations asked", "h [s]"})
    csv.add(name);
  for (const RowNumber& number : row_numbers)
    csv.add(std::string(number.name) + " [" + number.unit + "]");
  csv.end_row();
  for (const JamRow& row : rows) {
    csv.add(row.time, 9);
    csv.add(row.force, 9);
    csv.add(static_cast<long>(row.grains));
    csv.add(row.solver);
    csv.add(static_cast<long>(row.iterations));
    csv.add(row.h, 6);
    for (const RowNumber& number : row_numbers) csv.add(number.of(row), 6);
    csv.end_row();
  }
  return csv.take();
}

}  // namespace ballast
