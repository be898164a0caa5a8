#include "experiments/compare/live.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "experiments/run/manifest.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run/run_folder.hpp"
#include "experiments/run/simulation.hpp"
#include "platform/atomic_file.hpp"
#include "platform/child_process.hpp"
#include "platform/content_key.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Where every backend begins.
struct Start {
  MechanicalSystem system;
  MotionState state;
  StepMemory memory;
  std::optional<ControlVolume> control_volume;
  std::string key;  ///< of its checkpoint's content
};

/// A trajectory is kept as doubles: steps, frames, grains, how it ended, letters of why; then the
/// columns of each step, each frame's time and positions, and the letters.
enum class Ended { complete, time_limit, unsupported, failed };

const char* words_of(Ended ended) {
  switch (ended) {
    case Ended::complete:
      return "complete";
    case Ended::time_limit:
      return "time limit";
    case Ended::unsupported:
      return "the backend cannot take the problem";
    case Ended::failed:
      return "failed";
  }
  return "";
}

void append_step(const StepRecord& step, std::vector<double>& rows) {
  for (const StepColumn& column : step_columns()) rows.push_back(step.*column.value);
}

void append_frame(const MotionState& state, int grains, std::vector<double>& frames) {
  frames.push_back(state.time);
  for (int b = 0; b < grains; ++b)
    for (int axis = 0; axis < 3; ++axis)
      frames.push_back(state.pose[static_cast<size_t>(b)].position[axis]);
}

/// The scene run by its own solver to the common start, in a folder of its own: an ordinary run,
/// resumed if it is there.
void make_start(const LiveOptions& options, const Scene& scene) {
  RunOptions run_options;
  run_options.scene = options.scene;
  run_options.overrides = options.overrides;
  char duration[64];
  std::snprintf(duration, sizeof duration, "scene.duration=%.17g",
                std::max(options.start, scene.step));
  run_options.overrides.push_back(duration);
  run_options.output = options.folder / "start";
  run_options.packing_cache =
      options.packing_cache.empty() ? options.folder / "packings" : options.packing_cache;
  run_options.resume = RunFolder(run_options.output).has_run();
  if (run(run_options).code != ExitCode::ok)
    throw Error(run_options.output.string() + ": the start was not reached");
}

Start read_start(const LiveOptions& options, const Scene& scene) {
  const RunFolder folder(options.folder / "start");
  Start start;
  start.system = system_of_run(folder.path(), start.state);
  Checkpoint checkpoint = read_checkpoint(folder.checkpoint());
  start.memory = memory_of(checkpoint, folder.checkpoint());
  start.state = std::move(checkpoint.state);
  start.key = content_key(read_whole_file(folder.checkpoint()));
  if (scene.grains)
    start.control_volume = box_control_volume(
        scene, Manifest::read(folder.manifest()).summary_number("packing_top_m"));
  return start;
}

/// What the child does: steps until the end, or the time is over.
Ended step_on(const LiveOptions& options, const Scene& scene, Start start,
              const ComparedSolver& solver, double tolerance, std::vector<double>& rows,
              std::vector<double>& frames, std::string& why) {
  StepSettings settings = step_settings(scene);
  settings.solver.name = solver.name;
  settings.solver.tolerance = tolerance;
  settings.solver.max_iterations = options.max_iterations > 0 ? options.max_iterations : 1 << 30;
  settings.solver.max_seconds = options.max_seconds;
  TimeStepper stepper(start.system, settings, start.system.first_driven_wall());
  const long count = std::max(1L, std::lround(options.duration / settings.h)),
             frame_every = std::max(1L, count / 100);
  const auto begin = Clock::now();
  append_frame(start.state, start.system.grain_count, frames);
  try {
    for (long step = 1; step <= count; ++step) {
      if (std::chrono::duration<double>(Clock::now() - begin).count() > options.trajectory_seconds)
        return Ended::time_limit;
      StepRecord record = stepper.step(start.state, start.memory);
      if (start.control_volume && (step % frame_every == 0 || step == count))
        record.solid_fraction = start.control_volume->solid_fraction(start.system, start.state);
      else
        record.solid_fraction = std::nan("");
      append_step(record, rows);
      if (step % frame_every == 0 || step == count)
        append_frame(start.state, start.system.grain_count, frames);
    }
  } catch (const UnsupportedProblem& error) {
    why = error.what();
    return Ended::unsupported;
  } catch (const std::exception& error) {
    why = error.what();
    return Ended::failed;
  }
  return Ended::complete;
}

std::vector<double> in_child(const LiveOptions& options, const Scene& scene, const Start& start,
                             const ComparedSolver& solver, double tolerance) {
  const double most = options.trajectory_seconds + 1.25 * options.max_seconds + 5.0;
  const ChildResult child = run_in_child(most, [&](std::vector<double>& record) {
    std::vector<double> rows, frames;
    std::string why;
    const Ended ended = step_on(options, scene, start, solver, tolerance, rows, frames, why);
    const double grains = start.system.grain_count;
    record = {static_cast<double>(rows.size() / step_columns().size()),
              static_cast<double>(frames.size()) / (3.0 * grains + 1.0), grains,
              static_cast<double>(ended), static_cast<double>(why.size())};
    record.insert(record.end(), rows.begin(), rows.end());
    record.insert(record.end(), frames.begin(), frames.end());
    record.insert(record.end(), why.begin(), why.end());
  });
  if (child.end == ChildEnd::complete) return child.record;
  return {
      0.0, 0.0, 0.0,
      static_cast<double>(child.end == ChildEnd::out_of_time ? Ended::time_limit : Ended::failed),
      0.0};
}

void unpack(const std::vector<double>& record, const fs::path& file, Trajectory& trajectory) {
  const auto bad = [&] { throw Error(file.string() + ": is no trajectory: remove it"); };
  constexpr size_t head = 5;
  if (record.size() < head) bad();
  const size_t steps = static_cast<size_t>(record[0]), frames = static_cast<size_t>(record[1]),
               grains = static_cast<size_t>(record[2]);
  const size_t letters = static_cast<size_t>(record[4]);
  const size_t columns = step_columns().size();
  if (record.size() != head + steps * columns + frames * (1 + 3 * grains) + letters) bad();
  trajectory.ended = words_of(static_cast<Ended>(static_cast<int>(record[3])));
  const double* next = record.data() + head;
  for (size_t k = 0; k < steps; ++k) {
    StepRecord step;
    for (const StepColumn& column : step_columns()) step.*column.value = *next++;
    trajectory.steps.push_back(step);
  }
  for (size_t k = 0; k < frames; ++k) {
    trajectory.frame_times.push_back(*next++);
    trajectory.positions.emplace_back(
        Eigen::Map<const Eigen::VectorXd>(next, static_cast<Eigen::Index>(3 * grains)));
    next += 3 * grains;
  }
  if (letters > 0) trajectory.ended += ": ";
  for (size_t k = 0; k < letters; ++k) trajectory.ended += static_cast<char>(*next++);
}

std::vector<double> read_doubles(const fs::path& file) {
  const std::string bytes = read_whole_file(file);
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

Trajectory trajectory_of(const LiveOptions& options, const Scene& scene, const Start& start,
                         const std::string& binary, const ComparedSolver& solver,
                         double tolerance) {
  char numbers[160];
  std::snprintf(numbers, sizeof numbers, "|%.17g %.17g %.17g %.17g %d", tolerance, options.duration,
                options.max_seconds, options.trajectory_seconds, options.max_iterations);
  const fs::path file =
      options.folder / "trajectories" /
      (content_key("trajectory 2|" + binary + '|' + start.key + '|' + solver.name + numbers) +
       ".bin");
  Trajectory trajectory{
      solver.name, name_of(solver.law), tolerance, options.max_iterations, "", {}, {}, {}};
  if (!fs::exists(file)) {
    const std::vector<double> record = in_child(options, scene, start, solver, tolerance);
    if (InterruptGuard::requested()) return trajectory;
    write_whole_file(
        file, {reinterpret_cast<const char*>(record.data()), record.size() * sizeof(double)});
  }
  unpack(read_doubles(file), file, trajectory);
  return trajectory;
}

int reference_of(const std::vector<Trajectory>& trajectories) {
  int best = -1;
  for (size_t k = 0; k < trajectories.size(); ++k) {
    const Trajectory& t = trajectories[k];
    if (!t.is_complete() || t.law != name_of(ContactLaw::coulomb)) continue;
    if (best < 0 || t.tolerance < trajectories[static_cast<size_t>(best)].tolerance)
      best = static_cast<int>(k);
  }
  return best;
}

}  // namespace

std::string Trajectory::label() const {
  char text[32];
  if (max_iterations > 0)
    std::snprintf(text, sizeof text, " %d iterations", max_iterations);
  else
    std::snprintf(text, sizeof text, " %g", tolerance);
  return solver + text + (law == name_of(ContactLaw::coulomb) ? "" : " (" + law + ")");
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
                        const std::function<bool(const Trajectory&)>& said) {
  LiveComparison comparison;
  comparison.scene = read_scene(find_scene(options.scene), options.overrides);
  comparison.velocity_scale = step_settings(comparison.scene).velocity_scale();
  make_start(options, comparison.scene);
  const InterruptGuard guard;  // only now: run() has one of its own
  const Start start = read_start(options, comparison.scene);
  comparison.has_driven_wall = start.system.first_driven_wall() >= 0;
  create_folder(options.folder / "trajectories");
  const std::string binary = binary_key();
  bool goes_on = true;
  for (const double tolerance : options.tolerances)
    for (const ComparedSolver& solver : options.solvers) {
      if (!goes_on || InterruptGuard::requested()) break;
      comparison.trajectories.push_back(
          trajectory_of(options, comparison.scene, start, binary, solver, tolerance));
      goes_on = said(comparison.trajectories.back());
    }
  comparison.reference = reference_of(comparison.trajectories);
  return comparison;
}

}  // namespace ballast
