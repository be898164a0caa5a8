#include "experiments/run/run.hpp"

#include <iostream>
#include <optional>

#include "experiments/run/drive.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

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
