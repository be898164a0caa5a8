#include "experiments/box/packing.hpp"

#include <cmath>
#include <iostream>

#include "experiments/step/time_step.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/random.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

/// The scene with the deposit's step, solver and tolerance: only settings in packing_key() matter.
Scene stage_scene(const Scene& scene, BoxStage stage) {
  Scene staged = scene;
  staged.step = stage == BoxStage::settle ? scene.deposit.settle_step : scene.deposit.step;
  staged.gravity = deposit_gravity(scene);
  staged.solver = {.name = scene.deposit.solver,
                   .tolerance = scene.deposit.tolerance,
                   .max_iterations = scene.deposit.max_iterations,
                   .threads = scene.solver.threads};
  return staged;
}

/// deposit() with its arguments.
struct Depositor {
  const Scene& scene;
  const Rain& rain;
  const fs::path& part;
  const DepositProgress& progress;
  Packing& packing;
  const Packing* tile;
  const double fall_time = std::sqrt(2.0 * fall_height() / deposit_gravity(scene).norm());  // [s]
  BoxStage stage = BoxStage::rain;
  double rms_velocity = 0.0;

  bool run() {
    // Every stage starts from the last state of the stage before. A stopped deposit continues
    // within its stage.
    //
    //     rain -- at rest --> press -- lid_time --> settle -- settle_time --> packing
    //
    // Without a pressure of the lid there is no press. In a tiled box the rain is the fall of
    // grains into the seams between the copies.
    const DepositSpec& spec = scene.deposit;
    if (!continue_part()) start();
    if (stage == BoxStage::rain) {
      if (!steps(spec.max_time)) return false;
      end_rain();
    }
    if (stage == BoxStage::press) {
      if (!steps(spec.lid_time)) return false;
      // The pressed lid marks the height of the packing; then it is raised.
      packing.deposit.top = packing.state.pose[lid()].position.z();
      enter(BoxStage::settle);
    }
    if (!steps(spec.settle_time)) return false;
    packing.phase = "packing";
    packing.deposit.rest_velocity = rms_velocity;
    return true;
  }

  bool continue_part() {
    if (!path_exists(part)) return false;
    packing = read_checkpoint(part);
    if (packing.key != packing_key(scene)) return false;
    for (const BoxStage begun : {BoxStage::rain, BoxStage::press, BoxStage::settle})
      if (packing.phase == name_of(begun)) stage = begun;
    return true;
  }

  void start() {
    packing = {packing_key(scene), name_of(stage), {}, {}, {}};
    packing.deposit.lid = 2.0 * rain.height;  // out of the way
    box_system(scene, rain, stage, packing.deposit.lid, &packing.state);
    if (tile) place_copies(scene, tile->state, packing.state);
  }

  size_t lid() const { return rain.grains.size() + wall_lid; }

  /// Begins a stage, whose time counts from zero. To press, the lid is placed on the highest
  /// vertex; to settle, it is raised to its final height. It is at rest there.
  void enter(BoxStage next) {
    stage = next;
    packing.phase = name_of(stage);
    packing.state.time = 0.0;
    packing.state.step = 0;
    packing.deposit.lid =
        packing.deposit.top + (stage == BoxStage::settle ? scene.drive.lid_raise : 0.0);
    packing.state.pose[lid()].position = Vec3(0, 0, packing.deposit.lid);
    packing.state.velocity[lid()].setZero();
  }

  void end_rain() {
    if (!rests())
      throw Error("deposit: after deposit.max_time = " + std::to_string(scene.deposit.max_time) +
                  " s the grains still move at " + std::to_string(rms_velocity) +
                  " m/s rms: raise deposit.max_time or deposit.rest_velocity");
    packing.deposit.rain_time = packing.state.time;
    const MechanicalSystem system = box_system(scene, rain, BoxStage::rain, packing.deposit.lid);
    packing.deposit.top = packing_top(system, packing.state);
    enter(scene.deposit.lid_pressure_weight > 0.0 ? BoxStage::press : BoxStage::settle);
  }

  bool rests() const {
    // the packing cannot be at rest before the highest grain has fallen
    return packing.state.time > fall_time && rms_velocity < scene.deposit.rest_velocity;
  }

  /// The fall from the top of the rain, or into a seam, which is as wide as a grain.
  double fall_height() const {
    if (!tile) return rain.height;
    double widest = 0.0;
    for (const BodySpec& grain : rain.grains)
      widest = std::max(widest, 2.0 * grain.shape->circumradius());
    return widest;
  }

  /// Steps the current stage for `duration`, the rain only until it rests. False: interrupted.
  bool steps(double duration) {
    const MechanicalSystem system = box_system(scene, rain, stage, packing.deposit.lid);
    const Scene staged = stage_scene(scene, stage);
    TimeStepper stepper(system, staged, -1);
    Stopwatch since_saved;
    // needed where the last step of the stage was saved, so that the loop makes none
    rms_velocity = grain_rms_velocity(system, packing.state);
    const long last = std::lround(duration / staged.step);
    while (packing.state.step < last) {
      const StepRecord record = stepper.step(packing.state, packing.memory);
      rms_velocity = grain_rms_velocity(system, packing.state);
      const bool keep_going = progress(stage, rms_velocity, record);
      // The state at which the rain rests is never saved within the rain: a deposit continued from
      // there would make another step.
      if (stage == BoxStage::rain && rests()) break;
      if (!keep_going || since_saved.seconds() > scene.record.checkpoint_seconds) {
        write_checkpoint(part, packing);
        since_saved.restart();
      }
      if (!keep_going) return false;
    }
    return true;
  }
};

}  // namespace

bool deposit(const Scene& scene, const Rain& rain, const fs::path& part,
             const DepositProgress& progress, Packing& packing, const Packing* tile) {
  return Depositor{scene, rain, part, progress, packing, tile}.run();
}

bool read_packing(const fs::path& file, const std::string& key, Packing& packing) {
  if (!path_exists(file)) return false;
  packing = read_checkpoint(file);
  if (packing.key != key || packing.phase != "packing")
    throw Error(file.string() + ": a packing of other settings: delete it");
  return true;
}

MechanicalSystem drive_system(const Scene& scene, const Rain& rain, const Packing& packing,
                              MotionState& state) {
  state = packing.state;
  state.time = 0.0;
  state.step = 0;
  if (const double noise = scene.drive.start_noise; noise > 0.0) {
    Random random(scene.drive.start_noise_seed ^ 0x4e6f697365ull);  // its own stream: "Noise"
    for (size_t b = 0; b < rain.grains.size(); ++b)
      for (double& place : state.pose[b].position) place += random.uniform(-noise, noise);
  }
  return box_system(scene, rain, BoxStage::drive, packing.deposit.lid);
}

fs::path packing_file(const fs::path& cache, const std::string& key) {
  return cache / ("packing-" + key + ".bin");
}

bool load_or_deposit(const Scene& scene, const Rain& rain, const PackingOptions& order,
                     Packing& packing) {
  const std::string key = packing_key(scene);
  const fs::path file = packing_file(order.cache, key), part = file.string() + ".part";
  const auto say = [&](const std::string& words) {
    if (order.style != Progress::Style::quiet) std::cout << words << std::endl;
  };
  const auto find = [&] {
    const bool is_kept = read_packing(file, key, packing);
    if (is_kept) say("packing from the cache: " + file.string());
    return is_kept;
  };
  // no lock is needed: a packing that is there is complete
  if (find()) return true;
  create_folder(order.cache);
  const FileLock lock(file.string() + ".lock", [&](double waited) {
    if (waited == 0.0) say("waiting for the packing that another run deposits");
    return order.keep_going();
  });
  if (!lock.is_held()) return false;
  if (find()) return true;  // made by whoever held the lock
  Packing tile;
  const bool is_tiled = scene.deposit.tiles() > 1;
  if (is_tiled) {
    const Scene one = tile_of(scene);
    if (!load_or_deposit(one, make_rain(one), order, tile)) return false;
  }
  say("depositing " + std::to_string(rain.grains.size()) + " grains (kept in " + file.string() +
      ")");
  Progress progress(order.style);
  // the duration of the rain is not known beforehand
  const double end[] = {std::nan(""), scene.deposit.lid_time, scene.deposit.settle_time};
  const auto show = [&](BoxStage stage, double velocity, const StepRecord& record) {
    progress.show(name_of(stage), end[static_cast<int>(stage)], record, velocity);
    return order.keep_going();
  };
  const bool is_done = deposit(scene, rain, part, show, packing, is_tiled ? &tile : nullptr);
  progress.finish();
  if (!is_done) return false;
  write_checkpoint(file, packing);
  fs::remove(part);
  return true;
}

}  // namespace ballast
