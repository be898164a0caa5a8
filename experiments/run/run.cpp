#include "experiments/run/run.hpp"

#include <cmath>
#include <iostream>
#include <optional>

#include <sys/resource.h>

#include "experiments/record/recorder.hpp"
#include "experiments/run/capture.hpp"
#include "experiments/run/prepared_run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/interrupt.hpp"
#include "problems/scene/scene_file.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {

namespace {

// The loop of a run: step, measure, record, checkpoint; it ends with the scene, on request, or at a
// time limit.
enum class DriveEnd { finished, interrupted, time_limit };

struct DriveOrder {
  RunFolder folder;           ///< where records and checkpoints go
  std::string capture;        ///< which steps to keep (CaptureSettings::parse); empty: none
  double max_seconds = 1e30;  ///< wall clock of the loop
  Telling telling = Telling::reader;
};

/// Steps between two that are `rate` [Hz] apart, at least one; 0: none is asked for.
long steps_between(double rate, double h) {
  return rate > 0.0 ? std::max(1L, std::lround(1.0 / (rate * h))) : 0;
}

/// The loop with all that it writes.
class Drive {
 public:
  Drive(const ResolvedScene& resolved, const DriveOrder& order, const StepSettings& settings,
        PreparedRun& run, Recorder& recorder)
      : scene_(resolved.scene),
        key_(resolved.key),
        order_(order),
        h_(settings.h),
        run_(run),
        stepper_(run.system, settings, run.driven_wall),
        recorder_(recorder),
        pose_every_(steps_between(scene_.record.pose_rate, h_)),
        state_every_(steps_between(scene_.record.state_rate, h_)),
        progress_(order.telling) {
    if (!order.capture.empty())
      capture_.emplace(CaptureSettings::parse(order.capture), order.folder.capture(), h_,
                       scene_.gravity.norm());
    if (state_every_ > 0) create_folder(order.folder.states());
  }

  DriveEnd loop() {
    const Stopwatch watch;
    Stopwatch since_saved;
    DriveEnd end = DriveEnd::finished;
    // The first frame is the state that the drive begins with.
    if (run_.state.step == 0) store_poses();
    while (run_.state.step < scene_.step_count()) {
      StepRecord record = stepper_.step(run_.state, run_.memory);
      measure(record);
      store(record);
      if (run_.state.step >= scene_.step_count()) continue;
      if (InterruptGuard::requested())
        end = DriveEnd::interrupted;
      else if (watch.seconds() > order_.max_seconds)
        end = DriveEnd::time_limit;
      if (end != DriveEnd::finished) break;
      if (since_saved.seconds() > scene_.record.checkpoint_seconds) {
        save();
        since_saved.restart();
      }
    }
    save();
    progress_.finish();
    return end;
  }

 private:
  bool is_due(long every) const { return every > 0 && run_.state.step % every == 0; }

  /// What is measured between steps counts as part of the step's wall clock, here alone.
  void measure(StepRecord& record) {
    const Stopwatch watch;
    if (run_.control_volume)
      record.solid_fraction =
          run_.control_volume->solid_fraction(run_.system, run_.state, stepper_.team());
    if (capture_) capture_->observe(stepper_, run_.state, record);
    record.seconds_other += watch.seconds();
  }

  void store(const StepRecord& record) {
    recorder_.add_step(record);
    if (is_due(pose_every_)) store_poses();
    if (is_due(state_every_))
      write_checkpoint(order_.folder.state_at(run_.state.step), checkpoint());
    progress_.show(scene_.name, run_.state.time, scene_.duration, record);
  }

  void store_poses() {
    recorder_.add_poses(run_.state);
    recorder_.add_forces(run_.state, run_.memory, h_);
  }

  Checkpoint checkpoint() const { return {key_, "drive", run_.state, run_.memory, {}}; }

  void save() {
    recorder_.flush();
    write_checkpoint(order_.folder.checkpoint(), checkpoint());
  }

  const Scene& scene_;
  const std::string& key_;
  const DriveOrder& order_;
  double h_;
  PreparedRun& run_;
  TimeStepper stepper_;
  Recorder& recorder_;
  long pose_every_, state_every_;
  std::optional<StepCapture> capture_;
  Progress progress_;
};

/// Of all steps, also those before the run was last resumed.
void note_record(const RunFolder& folder, double velocity_scale, Manifest& manifest) {
  const std::vector<StepRecord> steps = read_steps(folder.path());
  double seconds = 0.0, error = 0.0;
  for (const StepRecord& row : steps) {
    error += row.error_rms / velocity_scale / static_cast<double>(steps.size());
    seconds += step_seconds(row);
  }
  manifest.summary("drive_seconds", seconds);
  manifest.summary("error_mean_relative", error);
}

/// Steps from run.state to the end of the scene; `run` is then where it ended. A checkpoint is
/// written every record.checkpoint_seconds and at the end, whatever ends it; records are made safe
/// before it, so that they never lack what it has. Times, error and memory are noted in the
/// manifest. Throws Error.
DriveEnd drive(const ResolvedScene& resolved, const DriveOrder& order, PreparedRun& run,
               Manifest& manifest) {
  const StepSettings settings = step_settings(resolved.scene);
  manifest.summary("step_s", settings.h);
  manifest.summary("velocity_scale_m_s", settings.velocity_scale());
  Recorder recorder(order.folder.path(), run.system, run.state.step, resolved.scene.record.forces);
  const Stopwatch watch;
  const long first = run.state.step;
  // What the steps need is given back before the record is put together in memory.
  const DriveEnd end = Drive(resolved, order, settings, run, recorder).loop();
  if (run.state.step > first)
    manifest.summary("ms_per_step",
                     1e3 * watch.seconds() / static_cast<double>(run.state.step - first));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  manifest.summary("peak_memory_MB", static_cast<double>(usage.ru_maxrss) / 1024.0);
  manifest.summary(steps_left_entry,
                   static_cast<double>(resolved.scene.step_count() - run.state.step));
  recorder.finish(resolved.text, manifest.text());
  note_record(order.folder, settings.velocity_scale(), manifest);
  return end;
}

/// One call of `ballast run`: the folder, the start, the drive, and what is said at the end.
class Run {
 public:
  Run(const RunOptions& options)
      : options_(options),
        resolved_(resolve_scene(find_scene(options.scene), options.overrides)),
        folder_(RunFolder::of(options.output, resolved_.scene.name)),
        manifest_(resolved_.scene.name, options.overrides, resolved_.key) {
    Scene& scene = resolved_.scene;
    scene.solver.threads = options.threads;
    // a backend that is missing is said before anything is written
    make_solver(scene.solver.name);
    if (scene.grains) make_solver(scene.deposit.solver);
  }

  RunEnd execute() {
    RunEnd end;
    end.folder = folder_.path();
    end.has_grains = resolved_.scene.grains.has_value();
    if (options_.deposit_only) {
      end.code = deposit_only();
    } else if (!open_folder()) {
      end.has_record = end.was_finished = true;
    } else if (!prepare()) {
      end.code = stopped(why_stopped());
    } else {
      const DriveOrder order{folder_, options_.capture, seconds_left(), options_.telling};
      const DriveEnd why = drive(resolved_, order, run_, manifest_);
      manifest_.write(folder_.manifest());
      end.has_record = why == DriveEnd::finished;
      if (!end.has_record) end.code = stopped(why);
    }
    return end;
  }

 private:
  double seconds_left() const { return options_.max_seconds - watch_.seconds(); }

  DriveEnd why_stopped() const {
    return InterruptGuard::requested() ? DriveEnd::interrupted : DriveEnd::time_limit;
  }

  /// Nobody else works in the folder from here on. False: there is nothing to do in it.
  bool open_folder() {
    if (options_.resume) folder_.reopen(resolved_.text);
    create_folder(folder_.path());
    lock_.emplace(folder_.path() / "run.lock", briefly);
    if (!lock_->is_held())
      throw Error(folder_.path().string() + ": " + lock_->holder() + " is working there");
    if (options_.begin_or_resume && folder_.is_finished(resolved_.key)) {
      if (options_.telling == Telling::reader)
        std::cout << folder_.path().string() << ": finished already" << std::endl;
      return false;
    }
    // from here on a run that is to be begun or resumed is one or the other
    if (options_.begin_or_resume && folder_.has_run()) {
      folder_.reopen(resolved_.text);
      options_.resume = true;
    }
    if (!options_.resume) {
      folder_.begin(resolved_.text, manifest_, options_.overwrite);
    } else if (is_there(folder_.manifest())) {
      manifest_ = Manifest::read(folder_.manifest());
    } else {
      manifest_.write(folder_.manifest());
    }
    return true;
  }

  PackingOrder packing_order() const {
    PackingOrder order;
    order.cache = options_.packing_cache.empty() ? folder_.path() / ".." / "packings"
                                                 : options_.packing_cache;
    order.anew = options_.new_packing && !options_.resume;
    order.telling = options_.telling;
    order.goes_on = [this] { return !InterruptGuard::requested() && seconds_left() > 0.0; };
    return order;
  }

  ExitCode deposit_only() const {
    const Scene& scene = resolved_.scene;
    if (!scene.grains) throw Error(options_.scene + ": --deposit-only: has no [grains] to deposit");
    Packing packing;
    double seconds = 0.0;
    const bool there = take_packing(scene, make_rain(scene), packing_order(), packing, seconds);
    return there ? ExitCode::ok : stopped(why_stopped());
  }

  /// From the scene, its packing, or the checkpoint. False: stopped while depositing.
  bool prepare() {
    if (!prepare_run(resolved_.scene, packing_order(), manifest_, run_)) return false;
    if (options_.resume && is_there(folder_.checkpoint())) {
      Checkpoint found = read_checkpoint(folder_.checkpoint());
      if (found.key != resolved_.key)
        throw Error(folder_.checkpoint().string() + ": belongs to another scene");
      run_.memory = std::move(found.memory);
      run_.state = std::move(found.state);
      manifest_.resumed(run_.state.step);
      manifest_.write(folder_.manifest());  // what is killed later has been resumed all the same
    }
    return true;
  }

  /// What a stopped run tells its user: how to go on.
  ExitCode stopped(DriveEnd end) const {
    const ExitCode code = end == DriveEnd::time_limit ? ExitCode::time_limit : ExitCode::failure;
    if (options_.telling != Telling::reader) return code;
    const std::string why = end == DriveEnd::time_limit ? "time limit reached" : "interrupted";
    std::cout << why << " at t = " << run_.state.time << " s; nothing is lost.";
    if (!options_.again.empty()) std::cout << " Continue with:\n  " << options_.again;
    std::cout << std::endl;
    return code;
  }

  RunOptions options_;
  Stopwatch watch_;
  ResolvedScene resolved_;
  RunFolder folder_;
  std::optional<FileLock> lock_;
  Manifest manifest_;
  PreparedRun run_;
};

}  // namespace

RunEnd run(const RunOptions& options) {
  InterruptGuard guard;
  return Run(options).execute();
}

}  // namespace ballast
