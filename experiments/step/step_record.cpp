#include "experiments/step/step_record.hpp"

#include <algorithm>
#include <string_view>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"

namespace ballast {
namespace {

constexpr StepColumn columns[] = {
    {"time", "s", "end of the step, from the start of the drive", &StepRecord::time},
    {"wall_x", "m",
     "outward displacement of the first driven wall from its start (Fig. 3); 0: there is none",
     &StepRecord::wall_x},
    {"wall_v", "m/s", "outward velocity of the driven wall", &StepRecord::wall_v},
    {"load", "N", "compressive driving force f at mid-step (Eq. 1)", &StepRecord::load},
    {"wall_force", "N", "force f_g of the grains on the driven wall, mean over the step",
     &StepRecord::wall_force},
    {"solid_fraction", "1",
     "solid fraction in the control volume, from the poses at the end of the step (Fig. 12); "
     "0: without grains",
     &StepRecord::solid_fraction},
    {"contacts", "1", "contact points handed to the solver", &StepRecord::contacts},
    {"active_contacts", "1", "contact points with a positive normal impulse",
     &StepRecord::active_contacts},
    {"iterations", "1", "solver iterations (sweeps)", &StepRecord::iterations},
    {"error_rms", "m/s", "judge: scaled natural map, rms over contacts", &StepRecord::error_rms},
    {"error_max", "m/s", "judge: scaled natural map, worst contact", &StepRecord::error_max},
    {"solved", "1",
     "judge: 1 where every part of the contact law is within the tolerance, 0 elsewhere",
     &StepRecord::solved},
    {"penetration_max", "m", "deepest overlap of any contact point at detection",
     &StepRecord::penetration_max},
    {"penetration_mean", "m",
     "overlap at detection, mean over active contact points (open ones count as 0)",
     &StepRecord::penetration_mean},
    {"kinetic_energy", "J", "of grains and driven walls, at the end of the step",
     &StepRecord::kinetic_energy},
    {"work_load", "J", "work of the driving force in this step", &StepRecord::work_load},
    {"work_gravity", "J", "work of gravity in this step, on the motion that velocities make",
     &StepRecord::work_gravity},
    {"work_prescribed", "J",
     "work of imposed motions (walls and bodies) and of applied body forces in this step",
     &StepRecord::work_prescribed},
    {"dissipated", "J",
     "dissipated in contacts in this step: minus impulse times mean relative velocity",
     &StepRecord::dissipated},
    {"work_gyroscopic", "J",
     "work of the gyroscopic term in this step (0 in exact arithmetic of free flight)",
     &StepRecord::work_gyroscopic},
    {"work_correction", "J",
     "potential energy that the overlap correction gave in this step (gravity's work on "
     "its displacements, sign changed)",
     &StepRecord::work_correction},
    {"energy_gained", "J",
     "energy that contacts gave beyond the free motion in this step: no law of contact "
     "does, the solver's error did",
     &StepRecord::energy_gained},
    {"restitution", "1",
     "highest coefficient of restitution, or what it was lowered to where it would have given "
     "energy: the lowest of those",
     &StepRecord::restitution},
    {"energy_residual", "J", "change of kinetic energy minus works plus dissipation in this step",
     &StepRecord::energy_residual},
    {"seconds_detect", "s", "wall clock of contact detection", &StepRecord::seconds_detect,
     "detection"},
    {"seconds_assemble", "s", "wall clock of assembly", &StepRecord::seconds_assemble, "assembly"},
    {"seconds_solve", "s", "wall clock of prepare and solve", &StepRecord::seconds_solve, "solver"},
    {"seconds_judge", "s", "wall clock of validation and judge", &StepRecord::seconds_judge,
     "validation and judge"},
    {"seconds_correct", "s", "wall clock of the overlap correction", &StepRecord::seconds_correct,
     "overlap correction"},
    {"seconds_other", "s", "wall clock of the rest of the step: integration, warm starts, measures",
     &StepRecord::seconds_other, "integration, measures"},
};

}  // namespace

std::string StepColumn::phase_word() const {
  return std::string(name).substr(std::string_view("seconds_").size());
}

std::span<const StepColumn> step_columns() { return columns; }

std::span<const StepColumn> step_phases() {
  // the phases stand together at the table's end
  constexpr auto first = std::find_if(std::begin(columns), std::end(columns),
                                      [](const StepColumn& column) { return column.phase; });
  static_assert(
      std::all_of(first, std::end(columns), [](const StepColumn& column) { return column.phase; }));
  return {first, std::end(columns)};
}

double step_seconds(const StepRecord& step) {
  double seconds = 0.0;
  for (const StepColumn& phase : step_phases()) seconds += step.*phase.value;
  return seconds;
}

void write_steps_csv(const std::filesystem::path& file, std::span<const StepRecord> steps) {
  AtomicFile table(file);
  CsvWriter csv;
  for (const StepColumn& column : columns) csv.add(column.name);
  csv.end_row();
  for (const StepRecord& step : steps) {
    table.write(csv.take());
    for (const StepColumn& column : columns) csv.add(step.*column.value, 17);
    csv.end_row();
  }
  table.write(csv.take());
  table.commit();
}

std::vector<double> record_column(std::span<const StepRecord> steps, double StepRecord::*value,
                                  double factor) {
  std::vector<double> values;
  values.reserve(steps.size());
  for (const StepRecord& step : steps) values.push_back(factor * (step.*value));
  return values;
}

}  // namespace ballast
