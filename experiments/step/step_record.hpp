#pragma once
// The results of a step: one row of named scalars, and the memory from which the next step begins.
// The table of columns is the only source of names, units and descriptions for CSV, HDF5 and the
// pages; it also says which columns are the wall clock of a phase of the step.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "geometry/contact/contact_detector.hpp"

namespace ballast {

struct StepRecord {
  double time = 0;  // end of step
  double wall_x = 0, wall_v = 0;
  double load = 0, wall_force = 0;
  double solid_fraction = 0;
  double contacts = 0, active_contacts = 0;
  double iterations = 0;
  double error_rms = 0, error_max = 0, solved = 0;
  double penetration_max = 0, penetration_mean = 0;
  double kinetic_energy = 0;
  double work_load = 0, work_gravity = 0, work_prescribed = 0, dissipated = 0, work_gyroscopic = 0;
  double work_correction = 0;
  double energy_gained = 0, restitution = 0;
  double energy_residual = 0;
  double seconds_detect = 0, seconds_assemble = 0, seconds_solve = 0, seconds_judge = 0,
         seconds_correct = 0, seconds_other = 0;
};

struct StepColumn {
  const char* name;  ///< snake_case, as in CSV and HDF5
  const char* unit;
  const char* description;
  double StepRecord::*value;
  /// The name of the phase on a page, where the column is the wall clock of a phase of the step;
  /// nullptr elsewhere. The phases add up to the step.
  const char* phase = nullptr;

  /// A phase's name in one word: the column's name without "seconds_".
  std::string phase_word() const;
};

std::span<const StepColumn> step_columns();

/// The columns that are phases, in the order of the step.
std::span<const StepColumn> step_phases();

/// The wall clock of a step: the sum of its phases [s].
double step_seconds(const StepRecord& step);

/// Writes a line of names and one line per step, in 17 digits, so that the same bits can be read
/// back. The file is written beside its target and renamed. Throws Error.
void write_steps_csv(const std::filesystem::path& file, std::span<const StepRecord> steps);

/// One value per step, times `factor` (from SI to the unit of a figure).
std::vector<double> record_column(std::span<const StepRecord> steps, double StepRecord::*value,
                                  double factor = 1.0);

/// The warm start and contacts of the last step. With the MotionState, they are all that the next
/// step depends on.
struct StepMemory {
  std::vector<ContactPoint> contacts;  ///< sorted by (body_a, body_b, feature)
  std::vector<Vec3> impulses;          ///< on body b, world frame [N s]
};

}  // namespace ballast
