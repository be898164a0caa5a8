#pragma once
// The paper's protocol (sec. 2): grains rain into the box, the lid comes down, is raised and fixed,
// and wall x_max is driven.

#include <filesystem>
#include <functional>

#include "experiments/step/time_step.hpp"
#include "problems/mechanics/solid_fraction.hpp"

namespace ballast {

/// The stages of the protocol; each is a MechanicalSystem of the same bodies with other walls.
enum class BoxStage { rain, press, settle, drive };
const char* name_of(BoxStage stage);

/// Bodies of the box in fixed order: grains 0 .. count-1, then these walls.
enum BoxWall {
  wall_floor,
  wall_lid,
  wall_x_min,
  wall_x_max,
  wall_y_min,
  wall_y_max,
  box_wall_count
};

/// The grains of a scene, generated or read from its meshes, at rest in a loose rain without
/// overlap above the floor.
struct Rain {
  std::vector<BodySpec> grains;
  double height = 0.0;  ///< of the rain [m]
};
Rain make_rain(const Scene& scene);

/// The system of one stage. `lid`: height of the lid's plane at the start of the stage [m].
MechanicalSystem box_system(const Scene& scene, const Rain& rain, BoxStage stage, double lid);

/// A deposited packing, ready to be driven: the poses and velocities at the end of the settling,
/// and how it came about.
struct Packing {
  MotionState state;           ///< grains and walls
  StepMemory memory;           ///< warm start for the first driven step
  double top = 0.0;            ///< highest vertex when the lid was raised [m]
  double lid = 0.0;            ///< height of the raised lid [m]
  double rain_time = 0.0;      ///< simulated until rest [s]
  double rest_velocity = 0.0;  ///< rms grain velocity at the end [m/s]
};

/// Says how far a stage is: simulated time of the stage, rms velocity [m/s], record of the last
/// step. Returning false stops the deposit (interrupt): it can be continued from `part`.
using DepositProgress =
    std::function<bool(BoxStage, double time, double rms_velocity, const StepRecord&)>;

/// Deposits. `part`: checkpoint file of an unfinished deposit, continued when it is there, written
/// every record.checkpoint_seconds and on interrupt. Returns false when interrupted. Throws Error
/// when the packing doesn't come to rest.
bool deposit(const Scene& scene, const Rain& rain, const std::filesystem::path& part,
             const DepositProgress& progress, Packing& packing);

/// Gravity while depositing [m/s^2]: deposit.gravity, else the scene's.
Vec3 deposit_gravity(const Scene& scene);

/// Key of everything a packing depends on: grains, box, deposit, lid, correction, format version.
/// Not of the drive, its solver, step or friction: runs that differ in these alone start from the
/// same packing.
std::string packing_key(const Scene& scene);

void write_packing(const std::filesystem::path& file, const std::string& key,
                   const Packing& packing);
/// False when the file is not there. Throws Error when it is broken or has another key.
bool read_packing(const std::filesystem::path& file, const std::string& key, Packing& packing);

/// The driven system and its initial state: time and step counted from the start of the drive.
MechanicalSystem drive_system(const Scene& scene, const Rain& rain, const Packing& packing,
                              MotionState& state);

/// Where the solid fraction is taken: from the floor to the packing's top before the lid was
/// raised, clear of the driven wall.
ControlVolume box_control_volume(const Scene& scene, double top);

/// rms speed of the grains [m/s], and the highest vertex [m].
double grain_rms_velocity(const MechanicalSystem& system, const MotionState& state);
double packing_top(const MechanicalSystem& system, const MotionState& state);

}  // namespace ballast
