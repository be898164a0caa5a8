#include "experiments/bench/scaling_bench.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/step/step_record.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/child_process.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/pack.hpp"
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

/// Solves the step's problem once more by another solver, and notes what that took.
void solve_again(const std::string& solver, const FrictionProblem& problem, const Impulses& start,
                 const Budget& budget, ScalingPoint& point) {
  const std::unique_ptr<Solver> backend = make_solver(solver);
  WorkerTeam team;
  team.resize(point.threads);
  backend->use_team(&team);
  SolverRunner runner;
  const SolverRun run = runner.run(*backend, problem, start, budget);
  point.iterations.push_back(run.is_solved() ? run.solved.iterations
                                             : std::numeric_limits<double>::infinity());
  point.seconds.push_back(run.prepare_seconds + run.solve_seconds);
}

/// What the child does.
ScalingPoint measure_packing(const DepositedBox& box, const ScalingOptions& options,
                             ScalingPoint point) {
  const double before = peak_bytes();
  BenchStart start = tiled_start(box, point.nx, point.ny);
  StepSettings settings = step_settings(box.scene);
  settings.solver.threads = point.threads;
  std::vector<double> detect, assemble, solve, step;
  TimeStepper stepper(start.system, settings, -1);
  const double ns = 1e9 / point.grains;
  // Steps with k < 0 warm up: the seams between the copies settle, caches fill.
  for (int k = -options.warm_up; k < options.steps; ++k) {
    const StepRecord r = stepper.step(start.state, start.memory);
    if (k < 0) continue;
    point.contacts = r.contacts;
    detect.push_back(ns * r.seconds_detect);
    assemble.push_back(ns * r.seconds_assemble);
    solve.push_back(ns * r.seconds_solve);
    step.push_back(ns * step_seconds(r));
  }
  point.detect = quantile(detect, 0.5);
  point.assemble = quantile(assemble, 0.5);
  point.solve = quantile(solve, 0.5);
  point.step = quantile(step, 0.5);
  point.bytes = (peak_bytes() - before) / point.grains;
  // The last step's problem once more: a sweep alone, then each solver to the tolerance.
  Impulses warm;
  stepper.warm_start(warm);
  point.sweep = ns * sweep_seconds(stepper.problem(), warm, options.sweeps, point.threads);
  Budget budget;
  budget.tolerance = options.tolerance * settings.velocity_scale();
  budget.max_iterations = options.max_iterations;
  if (options.cold_start) warm.setZero();
  for (const std::string& solver : options.solvers)
    solve_again(solver, stepper.problem(), warm, budget, point);
  return point;
}

/// What the child measured, on its way to the parent.
template <class Carrier, class Point>
void carry(Carrier& carrier, Point& point) {
  carrier.numbers(point.contacts, point.detect, point.assemble, point.solve, point.step,
                  point.sweep, point.bytes);
  carrier.list(point.iterations);
  carrier.list(point.seconds);
}

/// Measures the packing that `point` names in a child, and fills in what it measured.
void measure_in_child(const DepositedBox& box, const ScalingOptions& options, ScalingPoint& point) {
  // The peak of memory is a process' own: a child for each packing keeps them apart.
  const ChildResult child = run_in_child(options.max_seconds, [&] {
    const ScalingPoint measured = measure_packing(box, options, point);
    Packer packer;
    carry(packer, measured);
    return packer.bytes();
  });
  if (child.end != ChildEnd::complete)
    throw Error("bench scaling: " + std::to_string(static_cast<long>(point.grains)) +
                " grains: the child " +
                (child.end == ChildEnd::out_of_time ? "ran out of time" : "died (out of memory?)"));
  Unpacker unpacker(child.answer, "bench scaling: a child's answer");
  carry(unpacker, point);
  unpacker.finish();
}

}  // namespace

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

std::vector<Measurement> scaling_measurements(const ScalingOptions& options,
                                              const std::vector<ScalingPoint>& points) {
  std::vector<Measurement> result;
  for (const ScalingPoint& p : points) {
    const std::string group = std::to_string(p.threads) +
                              (p.threads == 1 ? " thread, " : " threads, ") +
                              std::to_string(static_cast<long>(p.grains)) + " grains";
    const auto add = [&](const std::string& name, const char* unit, double value) {
      result.push_back(measurement_of(group, name, unit, {value}));
    };
    add("contacts", "contacts", p.contacts);
    add("detect", "ns/grain", p.detect);
    add("assemble", "ns/grain", p.assemble);
    add("solve", "ns/grain", p.solve);
    add("step", "ns/grain", p.step);
    add("sweep", "ns/grain", p.sweep);
    add("sweep per contact", "ns/contact",
        p.contacts > 0.0 ? p.sweep * p.grains / p.contacts : 0.0);
    add("memory", "B/grain", p.bytes);
    for (size_t k = 0; k < p.iterations.size(); ++k) {
      const bool reached = std::isfinite(p.iterations[k]);
      if (reached) add("iterations needed, " + options.solvers[k], "iterations", p.iterations[k]);
      add((reached ? "time to the tolerance, " : "time, tolerance not reached, ") +
              options.solvers[k],
          "ms", 1e3 * p.seconds[k]);
    }
  }
  return result;
}

Figure scaling_figure(const ScalingOptions& options, const std::vector<ScalingPoint>& points) {
  struct Line {
    const char* title;
    double ScalingPoint::*value;
    Ink ink;
  };
  const Line lines[] = {{"detection", &ScalingPoint::detect, Ink::vermilion},
                        {"assembly", &ScalingPoint::assemble, Ink::orange},
                        {"a sweep", &ScalingPoint::sweep, Ink::blue}};
  const Ink solver_inks[] = {Ink::blue, Ink::green, Ink::purple, Ink::sky};
  Figure figure;
  figure.name = "scaling";
  figure.title = "Cost per grain over grains";
  figure.height = 620;
  figure.panels.resize(2);
  const auto add = [&](Panel& panel, int threads, const std::string& title, Ink ink,
                       const auto& value) {
    Curve curve;
    for (const ScalingPoint& p : points)
      if (p.threads == threads && std::isfinite(value(p))) {
        curve.x.push_back(p.grains);
        curve.y.push_back(value(p));
      }
    curve.title = title + (threads == 1 ? "" : ", " + std::to_string(threads) + " threads");
    curve.ink = ink;
    curve.dashed = threads != 1;
    panel.curves.push_back(std::move(curve));
  };
  for (const int threads : options.threads)
    for (const Line& line : lines)
      add(figure.panels[0], threads, line.title, line.ink,
          [&](const ScalingPoint& p) { return p.*line.value; });
  for (size_t k = 0; k < options.solvers.size(); ++k)
    add(figure.panels[1], options.threads.front(), options.solvers[k],
        solver_inks[k % std::size(solver_inks)],
        [k](const ScalingPoint& p) { return p.iterations.at(k); });
  figure.panels[0].y_label = "ns per grain";
  figure.panels[1].y_label = "iterations needed";
  for (Panel& panel : figure.panels) {
    panel.x_label = "grains";
    panel.log_x = true;
  }
  figure.panels[0].log_y = true;
  figure.panels[1].y_min = 0.0;
  return figure;
}

}  // namespace ballast
