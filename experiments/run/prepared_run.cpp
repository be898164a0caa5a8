#include "experiments/run/prepared_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/record/record_file.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

void note_box(const Scene& scene, const DepositState& deposit, PreparedRun& run,
              Manifest& manifest) {
  const double mass = run.system.mass_of_grains(), g = scene.gravity.norm();
  // What the run's page and the campaign's figures scale with.
  manifest.summary("grains", run.system.grain_count);
  manifest.summary("grain_mass_kg", mass);
  manifest.summary("weight_N", mass * g);
  manifest.summary("f_max_N", scene.drive.f_max_over_weight * mass * g);
  manifest.summary("wall_mass_kg", scene.drive.wall_mass_over_grains * mass);
  manifest.summary("frequency_Hz", scene.drive.frequency);
  manifest.summary("rain_time_s", deposit.rain_time);
  manifest.summary("packing_top_m", deposit.top);
  manifest.summary("lid_m", deposit.lid);
  manifest.summary("rest_velocity_m_s", deposit.rest_velocity);
  manifest.summary("solid_fraction_initial",
                   run.control_volume->solid_fraction(run.system, run.state));
  const auto& classes = scene.grains->distribution;
  const auto smaller = [](const SizeClass& a, const SizeClass& b) { return a.size < b.size; };
  manifest.summary("d_min_m", std::min_element(classes.begin(), classes.end(), smaller)->size);
}

bool prepare_box(const Scene& scene, const PackingOrder& order, Manifest& manifest,
                 PreparedRun& run) {
  const Rain rain = make_rain(scene);
  Packing packing;
  double deposit_seconds = std::numeric_limits<double>::quiet_NaN();
  if (!take_packing(scene, rain, order, packing, deposit_seconds)) return false;
  if (!std::isnan(deposit_seconds)) manifest.summary("deposit_seconds", deposit_seconds);
  run.system = drive_system(scene, rain, packing, run.state);
  run.memory = std::move(packing.memory);
  run.control_volume = box_control_volume(scene, packing.deposit.top);
  note_box(scene, packing.deposit, run, manifest);
  return true;
}

}  // namespace

bool prepare_run(const Scene& scene, const PackingOrder& order, Manifest& manifest,
                 PreparedRun& run) {
  if (!scene.grains)
    run.system = make_system(scene, run.state);
  else if (!prepare_box(scene, order, manifest, run))
    return false;
  run.driven_wall = run.system.first_driven_wall();
  return true;
}

MechanicalSystem system_of_run(const std::filesystem::path& path, MotionState& state) {
  const RunFolder folder(path);
  if (!folder.has_run()) throw Error(path.string() + ": no run here: scene.toml is missing");
  const bool started = is_there(folder.checkpoint());
  const Scene scene = read_scene(folder.scene());
  if (!scene.grains) {
    MechanicalSystem system = make_system(scene, state);
    require_same_bodies(path, system);
    if (started) state = read_checkpoint(folder.checkpoint()).state;
    return system;
  }
  if (!started) throw Error(folder.checkpoint().string() + ": missing: the run has no state yet");
  state = read_checkpoint(folder.checkpoint()).state;
  // the lid stands where the packing has put it; it does not move in a drive
  const Rain rain = make_rain(scene);
  MechanicalSystem system = box_system(scene, rain, BoxStage::drive,
                                       state.pose[rain.grains.size() + wall_lid].position.z());
  require_same_bodies(path, system);
  return system;
}

MechanicalSystem recorded_system(const std::filesystem::path& path, MotionState& state) {
  const RunFolder folder(path);
  const std::filesystem::path record = path / "record.h5";
  if (!folder.has_run() || !is_there(record)) return system_of_run(path, state);
  MechanicalSystem system = read_record_system(record);
  system.friction = scene_friction(folder.scene());
  if (is_there(folder.checkpoint())) state = read_checkpoint(folder.checkpoint()).state;
  return system;
}

}  // namespace ballast
