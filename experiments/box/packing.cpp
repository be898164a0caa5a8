#include "experiments/box/packing.hpp"

#include <cmath>
#include <iostream>
#include <limits>

#include "experiments/step/time_step.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/random.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

void save(const fs::path& file, const std::string& key, const std::string& phase,
          const Packing& packing) {
  write_checkpoint(file, {key, phase, packing.state, packing.memory, packing.deposit});
}

/// False when the file is of other settings, or of another phase than a deposit's.
bool load(const fs::path& file, const std::string& key, std::string& phase, Packing& packing) {
  Checkpoint found = read_checkpoint(file);
  if (found.key != key || !found.deposit) return false;
  phase = found.phase;
  packing = {std::move(found.state), std::move(found.memory), *found.deposit};
  return true;
}

/// The deposit's own step, solver and tolerance; of the scene only what the packing's key knows.
StepSettings stage_settings(const Scene& scene, BoxStage stage) {
  Scene staged = scene;
  staged.step = stage == BoxStage::settle ? scene.deposit.settle_step : scene.deposit.step;
  staged.gravity = deposit_gravity(scene);
  const int threads = scene.solver.threads;
  staged.solver = SolverSpec{};
  staged.solver.name = scene.deposit.solver;
  staged.solver.tolerance = scene.deposit.tolerance;
  staged.solver.max_iterations = scene.deposit.max_iterations;
  staged.solver.threads = threads;
  return step_settings(staged);
}

class Depositor {
 public:
  Depositor(const Scene& scene, const Rain& rain, const fs::path& part,
            const DepositProgress& progress, Packing& packing)
      : scene_(scene),
        rain_(rain),
        part_(part),
        progress_(progress),
        packing_(packing),
        key_(packing_key(scene)) {}

  bool run() {
    // Every stage goes on from the state that the one before has left. A deposit that was
    // stopped goes on within its stage.
    //
    //     rain -- at rest --> press -- lid_time --> settle -- settle_time --> packing
    //
    // Without a pressure of the lid there is no press.
    if (!continue_part()) start();
    if (stage_ == BoxStage::rain && !rain_to_rest()) return false;
    if (stage_ == BoxStage::press && !press()) return false;
    if (!steps(scene_.deposit.settle_time)) return false;
    packing_.deposit.rest_velocity = rms_velocity_;
    return true;
  }

 private:
  bool continue_part() {
    std::string phase;
    if (!is_there(part_) || !load(part_, key_, phase, packing_)) return false;
    for (const BoxStage stage : {BoxStage::rain, BoxStage::press, BoxStage::settle})
      if (phase == name_of(stage)) stage_ = stage;
    return true;
  }

  /// Each stage counts its time from zero.
  void enter(BoxStage stage) {
    stage_ = stage;
    packing_.state.time = 0.0;
    packing_.state.step = 0;
  }

  void start() {
    packing_.deposit.lid = 2.0 * rain_.height;  // out of the way
    box_system(scene_, rain_, BoxStage::rain, packing_.deposit.lid, &packing_.state);
  }

  bool rain_to_rest() {
    if (!steps(scene_.deposit.max_time)) return false;
    if (!rests())
      throw Error("deposit: after deposit.max_time = " + std::to_string(scene_.deposit.max_time) +
                  " s the grains still move at " + std::to_string(rms_velocity_) +
                  " m/s rms: raise deposit.max_time or deposit.rest_velocity");
    // The lid comes down on the highest vertex, or, unpressed, to where it stays for good.
    packing_.deposit.rain_time = packing_.state.time;
    const MechanicalSystem system = box_system(scene_, rain_, BoxStage::rain, packing_.deposit.lid);
    packing_.deposit.top = packing_top(system, packing_.state);
    const bool pressed = scene_.deposit.lid_pressure_weight > 0.0;
    place_lid(pressed ? packing_.deposit.top : packing_.deposit.top + scene_.drive.lid_raise);
    enter(pressed ? BoxStage::press : BoxStage::settle);
    return true;
  }

  bool rests() const {
    // nothing rests before the highest grain has fallen
    const double fall = std::sqrt(2.0 * rain_.height / deposit_gravity(scene_).norm());
    return packing_.state.time > fall && rms_velocity_ < scene_.deposit.rest_velocity;
  }

  bool press() {
    if (!steps(scene_.deposit.lid_time)) return false;
    // Pressed down, the lid itself says how high the packing is; then it is raised.
    packing_.deposit.top = packing_.state.pose[rain_.grains.size() + wall_lid].position.z();
    place_lid(packing_.deposit.top + scene_.drive.lid_raise);
    enter(BoxStage::settle);
    return true;
  }

  /// Moves the lid there, at rest.
  void place_lid(double height) {
    const size_t lid = rain_.grains.size() + wall_lid;
    packing_.deposit.lid = height;
    packing_.state.pose[lid].position = Vec3(0, 0, height);
    packing_.state.velocity[lid].setZero();
  }

  /// Steps the current stage for `duration`, the rain until it rests. False: interrupted.
  bool steps(double duration) {
    const MechanicalSystem system = box_system(scene_, rain_, stage_, packing_.deposit.lid);
    const StepSettings settings = stage_settings(scene_, stage_);
    TimeStepper stepper(system, settings, -1);
    Stopwatch since_saved;
    // also where the last step was saved, and none is left to measure it in
    rms_velocity_ = grain_rms_velocity(system, packing_.state);
    const long last = std::lround(duration / settings.h);
    while (packing_.state.step < last) {
      const StepRecord record = stepper.step(packing_.state, packing_.memory);
      rms_velocity_ = grain_rms_velocity(system, packing_.state);
      const bool goes_on = progress_(stage_, packing_.state.time, rms_velocity_, record);
      // The state that ends a stage is never saved within it: who went on from there would make
      // another step.
      if (stage_ == BoxStage::rain && rests()) break;
      // A checkpoint now and then, and one when it is to stop: the same call goes on there.
      if (!goes_on || since_saved.seconds() > scene_.record.checkpoint_seconds) {
        save(part_, key_, name_of(stage_), packing_);
        since_saved.restart();
      }
      if (!goes_on) return false;
    }
    return true;
  }

  const Scene& scene_;
  const Rain& rain_;
  const fs::path& part_;
  const DepositProgress& progress_;
  Packing& packing_;
  BoxStage stage_ = BoxStage::rain;
  std::string key_;
  double rms_velocity_ = 0.0;
};

}  // namespace

bool deposit(const Scene& scene, const Rain& rain, const fs::path& part,
             const DepositProgress& progress, Packing& packing) {
  packing = Packing{};
  return Depositor(scene, rain, part, progress, packing).run();
}

void write_packing(const fs::path& file, const std::string& key, const Packing& packing) {
  save(file, key, "packing", packing);
}

bool read_packing(const fs::path& file, const std::string& key, Packing& packing) {
  if (!is_there(file)) return false;
  std::string phase;
  if (!load(file, key, phase, packing) || phase != "packing")
    throw Error(file.string() + ": a packing of other settings: delete it, or give --new-packing");
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

namespace {

void say(Telling telling, const std::string& words) {
  if (telling == Telling::reader) std::cout << words << std::endl;
}

bool find_packing(const fs::path& file, const std::string& key, Telling telling, Packing& packing) {
  if (!read_packing(file, key, packing)) return false;
  say(telling, "packing from the cache: " + file.string());
  return true;
}

/// deposit() with a line that says how far it is. When the rain will rest nobody knows.
bool deposit_visibly(const Scene& scene, const Rain& rain, const fs::path& part,
                     const PackingOrder& order, Packing& packing) {
  Progress progress(order.telling);
  BoxStage last = BoxStage::rain;
  const double end[] = {std::numeric_limits<double>::quiet_NaN(), scene.deposit.lid_time,
                        scene.deposit.settle_time};
  const auto show = [&](BoxStage stage, double time, double velocity, const StepRecord& record) {
    if (stage != last) progress.restart();
    last = stage;
    progress.show(name_of(stage), time, end[static_cast<int>(stage)], record, velocity);
    return order.goes_on();
  };
  const bool is_done = deposit(scene, rain, part, show, packing);
  progress.finish();
  return is_done;
}

}  // namespace

fs::path packing_file(const fs::path& cache, const std::string& key) {
  return (cache / ("packing-" + key + ".bin")).lexically_normal();
}

bool take_packing(const Scene& scene, const Rain& rain, const PackingOrder& order, Packing& packing,
                  double& deposit_seconds) {
  const std::string key = packing_key(scene);
  const fs::path file = packing_file(order.cache, key), part = file.string() + ".part";
  // without the lock: a packing that is there is whole
  if (!order.anew && find_packing(file, key, order.telling, packing)) return true;
  create_folder(order.cache);
  // one process deposits, the others wait for it
  const FileLock lock(file.string() + ".lock", [&](double waited) {
    if (waited == 0.0) say(order.telling, "waiting for the packing that another run deposits");
    return order.goes_on();
  });
  if (!lock.is_held()) return false;
  if (order.anew) {
    fs::remove(file);
    fs::remove(part);
  }
  if (find_packing(file, key, order.telling, packing))
    return true;  // made by whoever held the lock
  say(order.telling, "depositing " + std::to_string(rain.grains.size()) + " grains (kept in " +
                         file.string() + ")");
  const Stopwatch watch;
  if (!deposit_visibly(scene, rain, part, order, packing)) return false;
  write_packing(file, key, packing);
  fs::remove(part);
  deposit_seconds = watch.seconds();
  return true;
}

}  // namespace ballast
