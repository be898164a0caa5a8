#include "experiments/run/run.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include "experiments/record/recorder.hpp"
#include "platform/clock.hpp"
#include "platform/interrupt.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {

ResolvedScene resolve_run(const std::string& scene, const std::vector<std::string>& overrides) {
  const std::filesystem::path file = find_scene(scene);
  ResolvedScene resolved = resolve_scene(file, overrides);
  const auto require = [&](const char* key, const std::string& name) {
    try {
      find_solver(name);
    } catch (const UnknownSolver& error) {
      throw Error(file.string() + ": " + key + " = \"" + name + "\": " + error.what());
    }
  };
  require("solver.name", resolved.scene.solver.name);
  if (resolved.scene.grains) require("deposit.solver", resolved.scene.deposit.solver);
  return resolved;
}

void require_backends(const Scene& scene) {
  make_solver(scene.solver.name);
  if (scene.grains) make_solver(scene.deposit.solver);
}

bool prepare_run(const Scene& scene, const PackingOptions& order, Manifest& manifest,
                 PreparedRun& run) {
  if (scene.grains) {
    const Rain rain = make_rain(scene);
    Packing packing;
    if (!load_or_deposit(scene, rain, order, packing)) return false;
    run.system = drive_system(scene, rain, packing, run.state);
    run.memory = std::move(packing.memory);
    run.control_volume = box_control_volume(scene, packing.deposit.top);
    // Scales of the run's page and the campaign's figures that the scene does not contain.
    manifest.summary("grain_mass_kg", run.system.mass_of_grains());
    manifest.summary("packing_top_m", packing.deposit.top);
    manifest.summary("solid_fraction_initial",
                     run.control_volume->solid_fraction(run.system, run.state));
  } else {
    run.system = make_system(scene, run.state);
  }
  return true;
}

namespace {

/// The number of steps between two outputs at `rate` [Hz], at least one; 0: no output is asked for.
long steps_between(double rate, double h) {
  return rate > 0.0 ? std::lround(std::clamp(1.0 / (rate * h), 1.0, 1e15)) : 0;
}

/// One call of `ballast run`: the folder, the start, the drive, and the messages at the end.
class Run {
 public:
  Run(const RunOptions& options)
      : options_(options),
        resolved_(resolve_run(options.scene, options.overrides)),
        folder_(options.output.empty() ? std::filesystem::path("results") / resolved_.scene.name
                                       : options.output),
        manifest_(resolved_.scene.name, options.overrides, resolved_.key) {
    resolved_.scene.solver.threads = options.threads;
    require_backends(scene_);  // before anything is written
  }

  RunEnd execute() {
    try {
      return work();
    } catch (const InvalidProblem& error) {
      fail(error);
    } catch (const InvalidPolyhedron& error) {
      fail(error);
    } catch (const UnsupportedProblem& error) {
      fail(error);
    } catch (const std::invalid_argument& error) {
      fail(error);
    }
  }

 private:
  /// Rethrows an error that names no file, preceded by the scene and the time of the drive.
  [[noreturn]] void fail(const std::exception& error) const {
    const MotionState& at = run_.state;
    throw Error(options_.scene + ": " + (at.step > 0 ? printed("t = %.6g s: ", at.time) : "") +
                error.what());
  }

  RunEnd work() {
    RunEnd end;
    end.folder = folder_.path();
    if (options_.deposit_only) {
      if (!scene_.grains)
        throw Error(options_.scene + ": --deposit-only: has no [grains] to deposit");
      Packing packing;
      if (!load_or_deposit(scene_, make_rain(scene_), packing_order(), packing))
        end.code = why_to_stop();
    } else if (!open_folder()) {
      end.was_finished = true;
    } else {
      end.code = prepare() ? drive() : why_to_stop();
    }
    if (end.code != ExitCode::ok) tell_how_to_go_on(end.code);
    return end;
  }

  /// The reason to stop; ok: there is none.
  ExitCode why_to_stop() const {
    if (InterruptGuard::requested()) return ExitCode::failure;
    return watch_.seconds() < options_.max_seconds ? ExitCode::ok : ExitCode::time_limit;
  }

  /// Returns whether nothing is left to do, and prints that.
  bool is_finished() const {
    if (!options_.resume || !folder_.has_run() || !folder_.is_finished(resolved_.key)) return false;
    if (options_.style != Progress::Style::quiet)
      std::cout << folder_.path().string() << ": finished already"
                << (options_.capture.to > 0 ? ": no step is left to capture" : "") << std::endl;
    return true;
  }

  /// Locks the folder, then begins or resumes the run there. False: nothing is left to do.
  bool open_folder() {
    if (is_finished()) return false;  // also in a folder without write access
    create_folder(folder_.path());
    lock_.emplace(folder_.path() / "run.lock", briefly);
    lock_->require_held();
    is_resumed_ = options_.resume && folder_.has_run();
    if (!is_resumed_) {
      folder_.begin(resolved_.text, manifest_, options_.overwrite);
      return true;
    }
    if (is_finished()) return false;  // another process has done it meanwhile
    if (read_whole_file(folder_.scene()) == resolved_.text) {
      manifest_ = Manifest::read(folder_.manifest());
      if (manifest_.key() == resolved_.key) return true;  // the key covers the meshes too
    }
    throw Error(folder_.path().string() +
                ": holds a run of other settings: give the same scene and --set, or --overwrite");
  }

  PackingOptions packing_order() const {
    // Relative to the folder's name: where it is a link, the kernel's ".." is another folder.
    const std::filesystem::path beside = (folder_.path() / ".." / "packings").lexically_normal();
    return {options_.packing_cache.empty() ? beside : options_.packing_cache,
            [this] { return why_to_stop() == ExitCode::ok; }, options_.style};
  }

  /// Takes the state from scene, packing or checkpoint. False: stopped while depositing.
  bool prepare() {
    if (!prepare_run(scene_, packing_order(), manifest_, run_)) return false;
    if (is_resumed_ && path_exists(folder_.checkpoint())) {
      Checkpoint found = folder_.read_state(folder_.checkpoint());
      run_.memory = std::move(found.memory);
      run_.state = std::move(found.state);
      manifest_.resumed(run_.state.step);
    }
    // Written here so that a run killed later has its packing and resumption noted.
    manifest_.write(folder_.manifest());
    return true;
  }

  /// Steps to the end of the scene, or until something stops it. Times, error and memory are noted
  /// in the manifest. Throws Error.
  ExitCode drive() {
    Recorder recorder(folder_.path(), run_.system, run_.state.step, scene_.record.forces);
    const Stopwatch watch;
    const long first = run_.state.step;
    // step_on() frees the memory of the steps before the record is put together in memory.
    const ExitCode end = step_on(recorder);
    if (const long done = run_.state.step - first; done > 0)
      manifest_.summary("ms_per_step", 1e3 * watch.seconds() / static_cast<double>(done));
    manifest_.summary("peak_memory_MB", peak_memory_MB());
    manifest_.summary(steps_left_entry, static_cast<double>(scene_.step_count() - run_.state.step));
    // over all steps, also those before the run was last resumed
    const std::vector<StepRecord> steps = read_steps(folder_.path());
    double seconds = 0.0, error = 0.0;
    for (const StepRecord& row : steps) {
      error += row.error_rms / velocity_scale(scene_) / static_cast<double>(steps.size());
      seconds += step_seconds(row);
    }
    manifest_.summary("drive_seconds", seconds);
    manifest_.summary("error_mean_relative", error);
    recorder.finish(resolved_.text, manifest_.text());
    manifest_.write(folder_.manifest());
    return end;
  }

  /// The loop: step, measure, record, checkpoint. A checkpoint is written every
  /// record.checkpoint_seconds and at the end, whatever ends the loop. The records are made safe
  /// before it, so that they never lack a step that it has.
  ExitCode step_on(Recorder& recorder) {
    TimeStepper stepper(run_.system, scene_, run_.system.first_driven_wall());
    Progress progress(options_.style);
    StepCapture capture(options_.capture, folder_.capture(), scene_.step, scene_.gravity.norm());
    // Phases are relative to the fastest wall velocity of the whole run.
    if (run_.state.step > 0 && options_.capture.to > 0)
      for (const StepRecord& row : read_steps(folder_.path())) capture.see(row);
    const RecordSpec& spec = scene_.record;
    const long pose_every = steps_between(spec.pose_rate, scene_.step),
               state_every = steps_between(spec.state_rate, scene_.step);
    if (state_every > 0) create_folder(folder_.states());
    const auto is_due = [&](long every) { return every > 0 && run_.state.step % every == 0; };
    const auto store_frame = [&] { recorder.add_frame(run_.state, run_.memory, scene_.step); };
    const auto save = [&](const std::filesystem::path& file) {
      write_checkpoint(file, {resolved_.key, "drive", run_.state, run_.memory, {}});
    };
    Stopwatch since_saved;
    ExitCode end = ExitCode::ok;
    // The first frame is the state that the drive begins with.
    if (run_.state.step == 0) store_frame();
    while (run_.state.step < scene_.step_count() && end == ExitCode::ok) {
      StepRecord record = stepper.step(run_.state, run_.memory);
      // Measurements between steps count as part of the step's wall clock only here.
      const Stopwatch watch;
      if (run_.control_volume)
        record.solid_fraction =
            run_.control_volume->solid_fraction(run_.system, run_.state, stepper.team());
      capture.observe(stepper, run_.state, run_.memory, record);
      record.seconds_other += watch.seconds();

      recorder.add_step(record);
      if (is_due(pose_every)) store_frame();
      if (is_due(state_every)) save(folder_.state_at(run_.state.step));
      progress.show(scene_.name, scene_.duration, record);
      if (run_.state.step < scene_.step_count()) end = why_to_stop();
      if (since_saved.seconds() > spec.checkpoint_seconds) {
        recorder.flush();
        save(folder_.checkpoint());
        since_saved.restart();
      }
    }
    recorder.flush();
    save(folder_.checkpoint());
    progress.finish();
    return end;
  }

  void tell_how_to_go_on(ExitCode end) const {
    if (options_.style == Progress::Style::quiet) return;
    std::cout << (end == ExitCode::time_limit ? "time limit reached" : "interrupted")
              << " at t = " << run_.state.time << " s; nothing is lost.";
    if (!options_.again.empty()) std::cout << " Continue with:\n  " << options_.again;
    std::cout << std::endl;
  }

  const RunOptions& options_;
  Stopwatch watch_;
  ResolvedScene resolved_;
  const Scene& scene_ = resolved_.scene;
  RunFolder folder_;
  std::optional<FileLock> lock_;
  Manifest manifest_;
  bool is_resumed_ = false;
  PreparedRun run_;
};

}  // namespace

RunEnd run(const RunOptions& options) {
  InterruptGuard guard;
  return Run(options).execute();
}

}  // namespace ballast
