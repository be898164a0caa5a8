#include "experiments/compare/live.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;

constexpr const char* out_of_time = "time limit";
constexpr SealedKind trajectory_kind{"BALTRAJ3", "trajectory", 1};

/// Packs or unpacks the motion; the solver and its tolerance are in the file's name.
template <class Carrier, class Of>
void carry_trajectory(Carrier& carrier, Of& trajectory) {
  carrier.text(trajectory.ended);
  carrier.list(trajectory.steps, [&](auto& step) {
    for (const StepColumn& column : step_columns()) carrier.number(step.*column.value);
  });
  carrier.list(trajectory.frame_times);
  carrier.list(trajectory.positions, [&](auto& centres) { carrier.list(centres); });
}

/// A trajectory as bytes, for a file or as a child's answer.
std::string packed(const Trajectory& trajectory) {
  Packer packer;
  carry_trajectory(packer, trajectory);
  return packer.bytes();
}

/// Unpacks what packed() made; solver and limits stay. Throws Error that begins with `origin`.
void unpack(const std::string& bytes, const std::string& origin, Trajectory& trajectory) {
  Unpacker unpacker(bytes, origin);
  carry_trajectory(unpacker, trajectory);
  unpacker.finish();
  unpacker.require(trajectory.positions.size() == trajectory.frame_times.size());
}

/// The start of every backend.
struct Start : PreparedRun {
  std::string key;  ///< of this program and of the checkpoint's content
};

/// Runs the scene with its own solver to the start: an ordinary run, in a folder of its own.
Start make_start(const LiveOptions& options, const Scene& scene) {
  RunOptions run_options;
  run_options.scene = options.scene;
  run_options.overrides = options.overrides;
  run_options.overrides.push_back(
      printed("scene.duration=%.17g", std::max(options.start, scene.step)));
  std::string which = run_options.scene;
  for (const std::string& one : run_options.overrides) which += '\n' + one;
  run_options.output = options.folder / ("start_" + content_key(which));
  run_options.packing_cache =
      options.packing_cache.empty() ? options.folder / "packings" : options.packing_cache;
  run_options.style = options.style;
  run_options.resume = true;
  if (run(run_options).code != ExitCode::ok)
    throw Error(run_options.output.string() + ": the start was not reached");
  const RunFolder folder(run_options.output);
  Start start;
  start.system = system_of_run(folder.path(), start.state);
  start.memory = read_checkpoint(folder.checkpoint()).memory;
  start.key = binary_key() + '|' + content_key(read_whole_file(folder.checkpoint()));
  if (scene.grains)
    start.control_volume = box_control_volume(
        scene, Manifest::read(folder.manifest()).summary_number("packing_top_m"));
  return start;
}

void append_frame(const MotionState& state, int grains, Trajectory& trajectory) {
  Eigen::VectorXd positions(3 * grains);
  for (int b = 0; b < grains; ++b)
    positions.segment<3>(3 * b) = state.pose[static_cast<size_t>(b)].position;
  trajectory.frame_times.push_back(state.time);
  trajectory.positions.push_back(std::move(positions));
}

/// Runs in the child: steps until the end or the time limit.
void step_on(const LiveOptions& options, Scene scene, Start start, const ComparedSolver& solver,
             Trajectory& trajectory) {
  scene.solver.name = solver.name;
  const bool has_count = trajectory.iterations > 0;
  scene.solver.tolerance = has_count ? 1e-12 : trajectory.tolerance;  // never reached
  scene.solver.max_iterations = has_count ? trajectory.iterations : 1 << 30;
  scene.solver.max_seconds = options.max_seconds;
  scene.solver.threads = options.threads;
  TimeStepper stepper(start.system, scene, start.system.first_driven_wall());
  const long count = std::max(1L, std::lround(options.duration / scene.step)),
             frame_every = std::max(1L, count / 100);
  const Stopwatch watch;
  append_frame(start.state, start.system.grain_count, trajectory);
  for (long step = 1; step <= count; ++step) {
    if (watch.seconds() > options.trajectory_seconds) {
      trajectory.ended = out_of_time;
      return;
    }
    StepRecord record = stepper.step(start.state, start.memory);
    const bool has_frame = step % frame_every == 0 || step == count;
    record.solid_fraction = start.control_volume && has_frame
                                ? start.control_volume->solid_fraction(start.system, start.state)
                                : std::nan("");
    trajectory.steps.push_back(record);
    if (has_frame) append_frame(start.state, start.system.grain_count, trajectory);
  }
  trajectory.ended = Trajectory::complete;
}

/// Fills the trajectory in a child process, which may crash, hang or be interrupted.
void step_in_child(const LiveOptions& options, const Scene& scene, const Start& start,
                   const ComparedSolver& solver, Trajectory& trajectory) {
  const double most = options.trajectory_seconds + 1.25 * options.max_seconds + 5.0;
  const ChildResult child = run_in_child(most, [&] {
    Trajectory made = trajectory;
    try {
      step_on(options, scene, start, solver, made);
    } catch (const UnsupportedProblem& error) {
      made.ended = std::string("the backend cannot take the problem: ") + error.what();
    } catch (const std::exception& error) {  // the steps before it are kept
      made.ended = std::string("failed: ") + error.what();
    }
    return packed(made);
  });
  if (child.end == ChildEnd::complete)
    unpack(child.answer, "ballast compare --live: a child's answer", trajectory);
  else
    trajectory.ended = child.end == ChildEnd::out_of_time ? out_of_time : "failed";
}

/// Reads the trajectory from its file, or makes it and stores it there.
Trajectory trajectory_of(const LiveOptions& options, const Scene& scene, const Start& start,
                         const ComparedSolver& solver, Trajectory trajectory) {
  const std::string numbers = printed(
      "|%.17g %.17g %.17g %.17g %d %d", trajectory.tolerance, options.duration, options.max_seconds,
      options.trajectory_seconds, trajectory.iterations, options.threads);
  const fs::path file =
      options.folder / "trajectories" /
      (content_key("trajectory 4|" + start.key + '|' + solver.name + numbers) + ".bin");
  if (path_exists(file)) {
    Trajectory stored = trajectory;
    try {
      unpack(read_sealed_file(file, trajectory_kind), file.string(), stored);
      return stored;
    } catch (const Error& error) {
      std::cerr << "ballast: " << error.what() << "; it is made again" << std::endl;
    }
  }
  step_in_child(options, scene, start, solver, trajectory);
  // an interrupt reaches the child as well, so its answer is no result
  if (!InterruptGuard::requested()) write_sealed_file(file, trajectory_kind, packed(trajectory));
  return trajectory;
}

std::string command_of(const LiveOptions& options) {
  std::string command = "ballast compare --live " + shell_quoted(options.scene);
  for (const std::string& one : options.overrides) command += " --set " + shell_quoted(one);
  return command + printed(" --from %g --duration %g --max-seconds %g", options.start,
                           options.duration, options.max_seconds);
}

}  // namespace

double Trajectory::mean_error() const {
  double sum = 0.0;
  for (const StepRecord& step : steps) sum += step.error_rms;
  return sum / static_cast<double>(steps.size());
}

std::string Trajectory::backend() const {
  return solver + (law == name_of(ContactLaw::coulomb) ? "" : " (" + law + ")");
}

std::string Trajectory::label() const {
  return backend() +
         (iterations > 0 ? printed(" %d iterations", iterations) : printed(" %g", tolerance));
}

const Trajectory* LiveComparison::reference() const {
  const Trajectory* best = nullptr;
  double least = HUGE_VAL;
  for (const Trajectory& t : trajectories) {
    const bool is_exact = t.law == name_of(ContactLaw::coulomb);
    if (!t.is_complete() || !is_exact || !(t.mean_error() < least)) continue;
    least = t.mean_error();
    best = &t;
  }
  return best;
}

std::vector<double> distances(const Trajectory& trajectory, const Trajectory& reference) {
  std::vector<double> result;
  for (size_t k = 0; k < std::min(trajectory.positions.size(), reference.positions.size()); ++k) {
    const Eigen::VectorXd& p = trajectory.positions[k];
    const double grains = static_cast<double>(p.size()) / 3.0;
    result.push_back(grains > 0.0 ? std::sqrt((p - reference.positions[k]).squaredNorm() / grains)
                                  : 0.0);
  }
  return result;
}

LiveComparison run_live(const LiveOptions& options,
                        const std::function<void(const Trajectory&)>& said) {
  LiveComparison comparison;
  comparison.scene = resolve_run(options.scene, options.overrides).scene;
  comparison.velocity_scale = velocity_scale(comparison.scene);
  const Start start = make_start(options, comparison.scene);
  const InterruptGuard guard;  // after make_start(): run() has one of its own
  comparison.has_driven_wall = start.system.first_driven_wall() >= 0;
  create_folder(options.folder / "trajectories");
  std::vector<Trajectory> wanted;
  for (const double tolerance : options.tolerances) wanted.emplace_back().tolerance = tolerance;
  for (const int count : options.iterations) {
    wanted.emplace_back().iterations = count;
    wanted.back().tolerance = not_known;
  }
  for (Trajectory& trajectory : wanted)
    for (const ComparedSolver& solver : options.solvers) {
      if (InterruptGuard::requested()) break;
      trajectory.solver = solver.name;
      trajectory.law = name_of(solver.law);
      comparison.trajectories.push_back(
          trajectory_of(options, comparison.scene, start, solver, trajectory));
      said(comparison.trajectories.back());
    }
  comparison.command = command_of(options);
  return comparison;
}

}  // namespace ballast
