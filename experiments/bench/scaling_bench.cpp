#include "experiments/bench/scaling_bench.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "experiments/step/step_record.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "platform/worker_team.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

double peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Wall clock of a sweep [s].
double sweep_seconds(const FrictionProblem& problem, const Impulses& start, int sweeps,
                     int threads) {
  WorkerTeam team;
  team.resize(threads);
  AnySweep sweep;
  sweep.use_team(&team);
  sweep.prepare(problem);
  sweep->load(problem, start);
  std::vector<double> seconds;
  for (int k = 0; k < sweeps; ++k) {
    const Stopwatch watch;
    sweep->sweep();
    seconds.push_back(watch.seconds());
  }
  return quantile(seconds, 0.5);
}

/// What the child does: steps, then the last step's problem once more, a sweep alone and each
/// solver to the tolerance.
void measure_packing(const DepositedBox& box, const ScalingOptions& options, ScalingPoint& point) {
  const auto add = [&](const std::string& name, const char* unit, std::vector<double> values) {
    const std::string grains = std::to_string(static_cast<long>(point.grains)) + " grains";
    point.measured.push_back(measurement_of(thread_words(point.threads) + ", " + grains, name, unit,
                                            {quantile(values, 0.5)}));
  };
  const double before = peak_bytes(), ns = 1e9 / point.grains;
  BenchStart start = tiled_start(box, point.nx, point.ny);
  Scene scene = box.scene;
  scene.solver.threads = point.threads;
  std::vector<StepRecord> steps;
  TimeStepper stepper(start.system, scene, -1);
  // Steps with k < 0 warm up: the seams between the copies settle, caches fill.
  for (int k = -options.warm_up; k < options.steps; ++k) {
    const StepRecord step = stepper.step(start.state, start.memory);
    if (k >= 0) steps.push_back(step);
  }
  std::vector<double> whole;
  for (const StepRecord& step : steps) whole.push_back(ns * step_seconds(step));
  const double contacts = steps.back().contacts;
  add("contacts", "contacts", {contacts});
  add("detect", "ns/grain", record_column(steps, &StepRecord::seconds_detect, ns));
  add("assemble", "ns/grain", record_column(steps, &StepRecord::seconds_assemble, ns));
  add("solve", "ns/grain", record_column(steps, &StepRecord::seconds_solve, ns));
  add("step", "ns/grain", whole);
  add("memory", "B/grain", {(peak_bytes() - before) / point.grains});
  Impulses warm;
  stepper.warm_start(warm);
  const double sweep = sweep_seconds(stepper.problem(), warm, options.sweeps, point.threads);
  add("sweep", "ns/grain", {ns * sweep});
  add("sweep per contact", "ns/contact", {1e9 * sweep / std::max(1.0, contacts)});
  const Budget budget{.tolerance = options.tolerance * velocity_scale(scene),
                      .max_iterations = options.max_iterations};
  WorkerTeam team;
  team.resize(point.threads);
  for (const std::string& name : options.solvers) {
    const std::unique_ptr<Solver> solver = make_solver(name);
    solver->use_team(&team);
    const SolverRun run = SolverRunner().run(*solver, stepper.problem(), warm, budget);
    if (run.is_solved())
      add("iterations needed, " + name, "iterations", {1.0 * run.solved.iterations});
    add((run.is_solved() ? "time to the tolerance, " : "time, tolerance not reached, ") + name,
        "ms", {1e3 * (run.prepare_seconds + run.solve_seconds)});
  }
}

/// What the child measured, on its way to the parent.
template <class Carrier, class List>
void carry(Carrier& carrier, List& measured) {
  carrier.list(measured, [&](auto& m) {
    for (auto* text : {&m.group, &m.name, &m.unit}) carrier.text(*text);
    carrier.numbers(m.median, m.mean, m.low, m.high, m.samples);
  });
}

/// Measures the packing that `point` names in a child, and fills in what it measured.
void measure_in_child(const DepositedBox& box, const ScalingOptions& options, ScalingPoint& point) {
  // The peak of memory is a process' own: a child for each packing keeps them apart.
  const ChildResult child = run_in_child(options.max_seconds, [&] {
    measure_packing(box, options, point);
    Packer packer;
    carry(packer, point.measured);
    return packer.bytes();
  });
  if (child.end != ChildEnd::complete)
    throw Error("bench scaling: " + std::to_string(static_cast<long>(point.grains)) +
                " grains: the child " +
                (child.end == ChildEnd::out_of_time ? "ran out of time" : "died (out of memory?)"));
  Unpacker unpacker(child.answer, "bench scaling: a child's answer");
  carry(unpacker, point.measured);
  unpacker.finish();
}

}  // namespace

double ScalingPoint::value(const std::string& name) const {
  const auto found = std::ranges::find(measured, name, &Measurement::name);
  return found == measured.end() ? not_known : found->median;
}

std::pair<int, int> tiles_for(long grains, int block) {
  // As nearly square as whole numbers allow.
  const double tiles = std::max(1.0, static_cast<double>(grains) / block);
  const int nx = std::max(1, static_cast<int>(std::lround(std::sqrt(tiles))));
  return {nx, std::max(1, static_cast<int>(std::lround(tiles / nx)))};
}

std::vector<ScalingPoint> measure_scaling(const DepositedBox& box, const ScalingOptions& options,
                                          const std::function<void(const ScalingPoint&)>& said) {
  std::vector<ScalingPoint> points;
  const int block = static_cast<int>(box.rain.grains.size());
  for (const long grains : options.grains)
    for (const int threads : options.threads) {
      ScalingPoint point;
      point.threads = threads;
      std::tie(point.nx, point.ny) = tiles_for(grains, block);
      point.grains = static_cast<double>(point.nx) * point.ny * block;
      measure_in_child(box, options, point);
      points.push_back(std::move(point));
      said(points.back());
    }
  return points;
}

Figure scaling_figure(const ScalingOptions& options, const std::vector<ScalingPoint>& points) {
  Panel cost{.x_label = "grains", .y_label = "ns per grain", .log_x = true, .log_y = true},
      iterations{.x_label = "grains", .y_label = "iterations needed", .log_x = true, .y_min = 0.0};
  const auto add = [&](const std::string& name, int threads, const std::string& title,
                       Panel& panel) {
    Curve curve = backend_curve(panel.curves.size(), title);
    curve.dashed = threads != 1;
    for (const ScalingPoint& p : points)
      if (const double value = p.value(name); p.threads == threads && std::isfinite(value)) {
        curve.x.push_back(p.grains);
        curve.y.push_back(value);
      }
    panel.curves.push_back(std::move(curve));
  };
  for (const int threads : options.threads)
    for (const char* name : {"detect", "assemble", "sweep"})
      add(name, threads, std::string(name) + ", " + thread_words(threads), cost);
  for (const std::string& solver : options.solvers)
    add("iterations needed, " + solver, options.threads.front(), solver, iterations);
  return {.name = "scaling",
          .title = "Cost per grain over grains",
          .height = 620,
          .panels = {cost, iterations}};
}

}  // namespace ballast
