#include "experiments/run/run.hpp"

#include <sys/resource.h>

#include <cmath>
#include <iostream>
#include <limits>

#include "experiments/box/packing_cache.hpp"
#include "experiments/export/paraview.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/record/progress.hpp"
#include "experiments/record/recorder.hpp"
#include "experiments/run/capture.hpp"
#include "experiments/run/manifest.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run/simulation.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/content_key.hpp"
#include "platform/error.hpp"
#include "platform/file_lock.hpp"
#include "platform/interrupt.hpp"
#include "problems/mechanics/solid_fraction.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

/// The run as its loop needs it.
struct Prepared {
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
  int driven_wall = -1;
  std::optional<ControlVolume> control_volume;  ///< of the vibrated box
};

class Run {
 public:
  Run(const RunOptions& options)
      : options_(options),
        scene_(read_scene(find_scene(options.scene), options.overrides)),
        text_(resolved_scene_text(find_scene(options.scene), options.overrides)),
        key_(content_key(text_)),
        folder_(RunFolder::of(options.output, scene_.name)),
        manifest_(scene_.name, options.overrides, key_) {
    scene_.solver.threads = options.threads;
    make_solver(scene_.solver.name);
    if (scene_.grains)
      make_solver(
          scene_.deposit.solver);  // a backend that is missing is said before anything is written
  }

  RunEnd execute() {
    RunEnd end;
    end.folder = folder_.path();
    end.has_grains = scene_.grains.has_value();
    if (options_.deposit_only) {
      end.code = deposit_only();
    } else if (!open_folder()) {
      end.has_record = end.was_finished = true;
    } else if (!prepare()) {
      end.code = stopped(why_stopped());
    } else {
      const LoopEnd why = loop();
      manifest_.write(folder_.manifest());
      end.has_record = why == LoopEnd::finished;
      if (!end.has_record) end.code = stopped(why);
    }
    return end;
  }

 private:
  double seconds_left() const { return options_.max_seconds - watch_.seconds(); }

  LoopEnd why_stopped() const {
    return InterruptGuard::requested() ? LoopEnd::interrupted : LoopEnd::time_limit;
  }

  /// Nobody else works in the folder from here on. False: there is nothing to do in it.
  bool open_folder() {
    if (options_.resume) folder_.reopen(text_);
    create_folder(folder_.path());
    lock_.emplace(folder_.path() / "run.lock", briefly);
    if (!lock_->is_held())
      throw Error(folder_.path().string() + ": " + lock_->holder() + " is working there");
    if (options_.begin_or_resume && folder_.is_finished(key_)) {
      std::cout << folder_.path().string() << ": finished already" << std::endl;
      return false;
    }
    if (options_.begin_or_resume && folder_.has_run()) {
      folder_.reopen(text_);
      options_.resume = true;
    }
    if (!options_.resume)
      folder_.begin(text_, options_.overwrite);
    else if (std::filesystem::exists(folder_.manifest()))
      manifest_ = Manifest::read(folder_.manifest());
    manifest_.write(folder_.manifest());
    return true;
  }

  ExitCode deposit_only() {
    if (!scene_.grains)
      throw Error(options_.scene + ": --deposit-only: has no [grains] to deposit");
    Packing packing;
    return take_packing(make_rain(scene_), packing) ? ExitCode::ok : stopped(why_stopped());
  }

  /// System, state and warm start: from the scene, the packing, or the checkpoint. False: stopped
  /// while depositing.
  bool prepare() {
    if (scene_.grains) {
      const Rain rain = make_rain(scene_);
      Packing packing;
      if (!take_packing(rain, packing)) return false;
      run_.system = drive_system(scene_, rain, packing, run_.state);
      run_.memory = packing.memory;
      run_.control_volume = box_control_volume(scene_, packing.top);
      describe_box(packing);
    } else {
      run_.system = make_system(scene_, run_.state);
    }
    run_.driven_wall = run_.system.first_driven_wall();
    if (options_.resume && std::filesystem::exists(folder_.checkpoint())) {
      Checkpoint found = read_checkpoint(folder_.checkpoint());
      if (found.key != key_)
        throw Error(folder_.checkpoint().string() + ": belongs to another scene");
      run_.memory = memory_of(found, folder_.checkpoint());
      run_.state = std::move(found.state);
      manifest_.resumed(run_.state.step);
      manifest_.write(folder_.manifest());  // what is killed later has been resumed all the same
    }
    return true;
  }

  bool take_packing(const Rain& rain, Packing& packing) {
    PackingOrder order;
    order.cache = options_.packing_cache.empty() ? folder_.path() / ".." / "packings"
                                                 : options_.packing_cache;
    order.anew = options_.new_packing && !options_.resume;
    order.goes_on = [this] { return !InterruptGuard::requested() && seconds_left() > 0.0; };
    double deposit_seconds = std::numeric_limits<double>::quiet_NaN();
    if (!ballast::take_packing(scene_, rain, order, packing, deposit_seconds)) return false;
    if (!std::isnan(deposit_seconds)) manifest_.summary("deposit_seconds", deposit_seconds);
    return true;
  }

  void describe_box(const Packing& packing) {
    const double mass = run_.system.mass_of_grains(), g = scene_.gravity.norm();
    manifest_.summary("grains", run_.system.grain_count);
    manifest_.summary("grain_mass_kg", mass);
    manifest_.summary("weight_N", mass * g);
    manifest_.summary("f_max_N", scene_.drive.f_max_over_weight * mass * g);
    manifest_.summary("wall_mass_kg", scene_.drive.wall_mass_over_grains * mass);
    manifest_.summary("frequency_Hz", scene_.drive.frequency);
    manifest_.summary("rain_time_s", packing.rain_time);
    manifest_.summary("packing_top_m", packing.top);
    manifest_.summary("lid_m", packing.lid);
    manifest_.summary("rest_velocity_m_s", packing.rest_velocity);
    manifest_.summary("solid_fraction_initial",
                      run_.control_volume->solid_fraction(run_.system, run_.state));
    double smallest = 1e300;
    for (const SizeClass& size : scene_.grains->distribution)
      smallest = std::min(smallest, size.size);
    manifest_.summary("d_min_m", smallest);
  }

  LoopEnd loop() {
    const StepSettings settings = step_settings(scene_);
    manifest_.summary("step_s", settings.h);
    manifest_.summary("velocity_scale_m_s", settings.velocity_scale());
    TimeStepper stepper(run_.system, settings, run_.driven_wall);
    Recorder recorder(folder_.path(), run_.system, run_.state.step);
    std::optional<ParaviewSeries> paraview;
    if (scene_.record.paraview) paraview.emplace(folder_.path(), run_.system, run_.state.step);
    std::optional<StepCapture> capture;
    if (!options_.capture.empty())
      capture.emplace(CaptureSettings::parse(options_.capture), folder_.capture(), settings.h,
                      scene_.gravity.norm());
    const long pose_every = std::max(1L, std::lround(1.0 / (scene_.record.pose_rate * settings.h)));
    const auto store_pose = [&] {
      recorder.add_poses(run_.state);
      if (paraview)
        paraview->add(run_.state, run_.memory.contacts, run_.memory.impulses, settings.h);
    };
    if (run_.state.step == 0) store_pose();
    const double state_rate = scene_.record.state_rate;
    const long state_every =
        state_rate > 0.0 ? std::max(1L, std::lround(1.0 / (state_rate * settings.h))) : 0;
    if (state_every > 0) create_folder(folder_.states());

    Progress progress;
    SimulationLoop loop;
    loop.last_step = scene_.step_count();
    loop.checkpoint_seconds = scene_.record.checkpoint_seconds;
    loop.max_seconds = seconds_left();
    loop.checkpoint = folder_.checkpoint();
    loop.key = key_;
    loop.phase = "drive";
    loop.before_checkpoint = [&] { recorder.flush(); };
    loop.observe = [&](const MotionState& state, StepRecord& record) {
      if (run_.control_volume) {
        const Stopwatch watch;
        record.solid_fraction = run_.control_volume->solid_fraction(run_.system, state);
        record.seconds_other += watch.seconds();
      }
      if (capture) {
        const Stopwatch watch;
        capture->observe(stepper, state, record);
        record.seconds_other += watch.seconds();
      }
      recorder.add_step(record);
      if (state.step % pose_every == 0) store_pose();
      if (state_every > 0 && state.step % state_every == 0)
        write_checkpoint(folder_.state_at(state.step),
                         drive_checkpoint(key_, loop.phase, state, run_.memory));
      progress.show(scene_.name, state.time, scene_.duration, record);
    };
    const Stopwatch watch;
    const long first = run_.state.step;
    const LoopEnd end = run_loop(loop, stepper, run_.state, run_.memory);
    progress.finish();
    if (run_.state.step > first)
      manifest_.summary("ms_per_step",
                        1e3 * watch.seconds() / static_cast<double>(run_.state.step - first));
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    manifest_.summary("peak_memory_MB", usage.ru_maxrss / 1024.0);
    manifest_.summary(steps_left_entry, static_cast<double>(loop.last_step - run_.state.step));
    recorder.finish(text_, manifest_.text());
    describe_record(settings.velocity_scale());
    return end;
  }

  /// Of all steps, also those before the run was last resumed.
  void describe_record(double velocity_scale) {
    const std::vector<StepRecord> steps = read_steps(folder_.path());
    double seconds = 0.0, error = 0.0;
    for (const StepRecord& row : steps) {
      error += row.error_rms / velocity_scale / static_cast<double>(steps.size());
      seconds += step_seconds(row);
    }
    manifest_.summary("drive_seconds", seconds);
    manifest_.summary("error_mean_relative", error);
  }

  /// What a stopped run tells its user: how to go on.
  ExitCode stopped(LoopEnd end) const {
    std::string command = "ballast run " + options_.scene;
    for (const std::string& set : options_.overrides) command += " --set '" + set + "'";
    if (!options_.capture.empty()) command += " --capture " + options_.capture;
    if (!options_.output.empty()) command += " --output " + options_.output.string();
    if (!options_.packing_cache.empty())
      command += " --packing-cache " + options_.packing_cache.string();
    command += options_.deposit_only ? " --deposit-only" : " --resume";
    const std::string why = end == LoopEnd::time_limit ? "time limit reached" : "interrupted";
    std::cout << why << " at t = " << run_.state.time << " s; nothing is lost. Continue with:\n  "
              << command << std::endl;
    return end == LoopEnd::time_limit ? ExitCode::time_limit : ExitCode::failure;
  }

  RunOptions options_;
  Stopwatch watch_;
  Scene scene_;
  std::string text_, key_;
  RunFolder folder_;
  std::optional<FileLock> lock_;
  Manifest manifest_;
  Prepared run_;
};

}  // namespace

RunEnd run(const RunOptions& options) {
  InterruptGuard guard;
  return Run(options).execute();
}

MechanicalSystem system_of_run(const std::filesystem::path& path, MotionState& state) {
  const RunFolder folder(path);
  if (!folder.has_run()) throw Error(path.string() + ": no run here: scene.toml is missing");
  const Scene scene = read_scene(folder.scene());
  const bool started = std::filesystem::exists(folder.checkpoint());
  if (!scene.grains) {
    MechanicalSystem system = make_system(scene, state);
    if (started) state = read_checkpoint(folder.checkpoint()).state;
    return system;
  }
  if (!started) throw Error(folder.checkpoint().string() + ": missing: the run has no state yet");
  state = read_checkpoint(folder.checkpoint()).state;
  const Rain rain = make_rain(scene);
  return box_system(scene, rain, BoxStage::drive,
                    state.pose[rain.grains.size() + wall_lid].position.z());
}

}  // namespace ballast
