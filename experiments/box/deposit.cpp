// The deposit: rain to rest, lid down, lid up, settle. See vibrated_box.hpp.

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "platform/clock.hpp"
#include "platform/content_key.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

/// Where a deposit stands: enough to continue from a checkpoint.
struct DepositState {
  BoxStage stage = BoxStage::rain;
  MotionState motion;
  StepMemory memory;
  double lid = 0.0, top = 0.0, rain_time = 0.0;
};

void save(const std::filesystem::path& part, const std::string& key, const DepositState& at) {
  write_checkpoint(part, {key,
                          name_of(at.stage),
                          at.motion,
                          at.memory.contacts,
                          at.memory.impulses,
                          {at.lid, at.top, at.rain_time}});
}

bool load(const std::filesystem::path& part, const std::string& key, DepositState& at) {
  if (!std::filesystem::exists(part)) return false;
  Checkpoint found = read_checkpoint(part);
  if (found.key != key || found.numbers.size() != 3) return false;
  for (BoxStage stage : {BoxStage::rain, BoxStage::press, BoxStage::settle})
    if (found.phase == name_of(stage)) at.stage = stage;
  at.motion = std::move(found.state);
  at.memory = {std::move(found.contacts), std::move(found.impulses)};
  at.lid = found.numbers[0];
  at.top = found.numbers[1];
  at.rain_time = found.numbers[2];
  return true;
}

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
  staged.sleep = SleepSpec{};  // a packing's key says nothing of it, nor of reuse
  staged.detection.reuse_motion = 0.0;
  return step_settings(staged);
}

void enter(DepositState& at, BoxStage stage) {
  at.stage = stage;
  at.motion.time = 0.0;
  at.motion.step = 0;
}

class Depositor {
 public:
  Depositor(const Scene& scene, const Rain& rain, const std::filesystem::path& part,
            const DepositProgress& progress)
      : scene_(scene), rain_(rain), part_(part), progress_(progress), key_(packing_key(scene)) {}

  bool run(Packing& packing) {
    DepositState at;
    if (!load(part_, key_, at)) start(at);
    if (at.stage == BoxStage::rain && !rain_to_rest(at)) return false;
    if (at.stage == BoxStage::press && !press(at)) return false;
    if (!steps(at, scene_.deposit.settle_time, [](double, double) { return false; })) return false;
    packing.state = std::move(at.motion);
    packing.memory = std::move(at.memory);
    packing.top = at.top;
    packing.lid = at.lid;
    packing.rain_time = at.rain_time;
    packing.rest_velocity = rms_velocity_;
    return true;
  }

 private:
  void start(DepositState& at) {
    at.lid = 2.0 * rain_.height;  // out of the way
    const MechanicalSystem system = box_system(scene_, rain_, BoxStage::rain, at.lid);
    for (const BodySpec& grain : rain_.grains) at.motion.pose.push_back(grain.pose);
    for (int w = 0; w < box_wall_count; ++w) {
      Pose pose;
      const WallSpec& wall = system.bodies[system.grain_count + w].wall;
      pose.position = wall.offset * wall.normal;
      at.motion.pose.push_back(pose);
    }
    at.motion.velocity.assign(at.motion.pose.size(), Vec3::Zero());
    at.motion.spin.assign(at.motion.pose.size(), Vec3::Zero());
  }

  bool rain_to_rest(DepositState& at) {
    // nothing rests before the highest grain has fallen
    const double fall = std::sqrt(2.0 * rain_.height / deposit_gravity(scene_).norm());
    bool rests = false;
    const auto stop = [&](double time, double velocity) {
      return rests = time > fall && velocity < scene_.deposit.rest_velocity;
    };
    if (!steps(at, scene_.deposit.max_time, stop)) return false;
    if (!rests)
      throw Error("deposit: after deposit.max_time = " + std::to_string(scene_.deposit.max_time) +
                  " s the grains still move at " + std::to_string(rms_velocity_) +
                  " m/s rms: raise deposit.max_time or deposit.rest_velocity");
    at.rain_time = at.motion.time;
    const MechanicalSystem system = box_system(scene_, rain_, BoxStage::rain, at.lid);
    at.top = packing_top(system, at.motion);
    const bool pressed = scene_.deposit.lid_pressure_weight > 0.0;
    place_lid(at, pressed ? at.top : at.top + scene_.drive.lid_raise);
    enter(at, pressed ? BoxStage::press : BoxStage::settle);
    return true;
  }

  bool press(DepositState& at) {
    if (!steps(at, scene_.deposit.lid_time, [](double, double) { return false; })) return false;
    at.top = at.motion.pose[rain_.grains.size() + wall_lid].position.z();
    place_lid(at, at.top + scene_.drive.lid_raise);
    enter(at, BoxStage::settle);
    return true;
  }

  void place_lid(DepositState& at, double height) {
    const size_t lid = rain_.grains.size() + wall_lid;
    at.lid = height;
    at.motion.pose[lid].position = Vec3(0, 0, height);
    at.motion.velocity[lid].setZero();
  }

  /// Steps the current stage for at most `duration`, or until stop(time, rms velocity). False:
  /// interrupted.
  template <class Stop>
  bool steps(DepositState& at, double duration, Stop&& stop) {
    const MechanicalSystem system = box_system(scene_, rain_, at.stage, at.lid);
    const StepSettings settings = stage_settings(scene_, at.stage);
    TimeStepper stepper(system, settings, -1);
    Stopwatch since_saved;
    const long last = std::lround(duration / settings.h);
    while (at.motion.step < last) {
      const StepRecord record = stepper.step(at.motion, at.memory);
      rms_velocity_ = grain_rms_velocity(system, at.motion);
      const bool goes_on = progress_(at.stage, at.motion.time, rms_velocity_, record);
      if (!goes_on || since_saved.seconds() > scene_.record.checkpoint_seconds) {
        save(part_, key_, at);
        since_saved.restart();
      }
      if (!goes_on) return false;
      if (stop(at.motion.time, rms_velocity_)) break;
    }
    return true;
  }

  const Scene& scene_;
  const Rain& rain_;
  const std::filesystem::path& part_;
  const DepositProgress& progress_;
  std::string key_;
  double rms_velocity_ = 0.0;
};

}  // namespace

bool deposit(const Scene& scene, const Rain& rain, const std::filesystem::path& part,
             const DepositProgress& progress, Packing& packing) {
  return Depositor(scene, rain, part, progress).run(packing);
}

void write_packing(const std::filesystem::path& file, const std::string& key,
                   const Packing& packing) {
  write_checkpoint(file, {key,
                          "packing",
                          packing.state,
                          packing.memory.contacts,
                          packing.memory.impulses,
                          {packing.top, packing.lid, packing.rain_time, packing.rest_velocity}});
}

bool read_packing(const std::filesystem::path& file, const std::string& key, Packing& packing) {
  if (!std::filesystem::exists(file)) return false;
  Checkpoint found = read_checkpoint(file);
  if (found.key != key || found.phase != "packing" || found.numbers.size() != 4)
    throw Error(file.string() + ": a packing of other settings: delete it, or give --new-packing");
  packing.state = std::move(found.state);
  packing.memory = {std::move(found.contacts), std::move(found.impulses)};
  packing.top = found.numbers[0];
  packing.lid = found.numbers[1];
  packing.rain_time = found.numbers[2];
  packing.rest_velocity = found.numbers[3];
  return true;
}

}  // namespace ballast
