#include "experiments/bench/step_bench.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "experiments/measure/wall_cycles.hpp"
#include "experiments/step/step_record.hpp"
#include "experiments/step/time_step.hpp"

namespace ballast {
namespace {

struct StepQuantity {
  std::string name;
  const char* unit;
  std::function<double(const BenchStep&)> value;
};

/// What is said of a set of steps. `scale` [m/s]: g h.
std::vector<StepQuantity> quantities(double scale) {
  const auto counter = [](long DetectionCounters::*count) {
    return [count](const BenchStep& s) { return static_cast<double>(s.counters.*count); };
  };
  const auto column = [](double StepRecord::*value) {
    return [value](const BenchStep& s) { return s.record.*value; };
  };
  std::vector<StepQuantity> all{
      {"step", "ms", [](const BenchStep& s) { return 1e3 * step_seconds(s.record); }},
      {"step, CPU", "ms", [](const BenchStep& s) { return 1e3 * s.cpu_seconds; }}};
  for (const StepColumn& phase : step_phases())
    all.push_back({phase.phase_word(), "ms",
                   [&phase](const BenchStep& s) { return 1e3 * (s.record.*phase.value); }});
  const StepQuantity rest[] = {
      {"pairs in the broad phase's list", "pairs", counter(&DetectionCounters::candidate_pairs)},
      {"separated by the cache", "pairs", counter(&DetectionCounters::cached_separations)},
      {"cached axis proved", "pairs", counter(&DetectionCounters::proved_axes)},
      {"full searches", "pairs", counter(&DetectionCounters::full_tests)},
      {"touching pairs", "pairs", counter(&DetectionCounters::manifolds)},
      {"contacts", "contacts", column(&StepRecord::contacts)},
      {"active contacts", "contacts", column(&StepRecord::active_contacts)},
      {"iterations", "iterations", column(&StepRecord::iterations)},
      {"error rms", "g h", [scale](const BenchStep& s) { return s.record.error_rms / scale; }},
      {"error of the worst contact", "g h",
       [scale](const BenchStep& s) { return s.record.error_max / scale; }},
      {"penetration max", "um", [](const BenchStep& s) { return 1e6 * s.record.penetration_max; }}};
  all.insert(all.end(), std::begin(rest), std::end(rest));
  return all;
}

void add_group(const std::string& group, const std::vector<const BenchStep*>& steps, double scale,
               std::vector<Measurement>& to) {
  if (steps.empty()) return;
  for (const StepQuantity& quantity : quantities(scale)) {
    std::vector<double> values;
    for (const BenchStep* step : steps) values.push_back(quantity.value(*step));
    const double worst = *std::max_element(values.begin(), values.end());
    to.push_back(measurement_of(group, quantity.name, quantity.unit, std::move(values)));
    if (quantity.name == "error rms")
      to.push_back(measurement_of(group, "error rms, worst step", quantity.unit, {worst}));
  }
  // of means: what an iteration costs, everything of the solver counted
  double solve = 0.0, visits = 0.0;
  for (const BenchStep* step : steps) {
    solve += step->record.seconds_solve;
    visits += step->record.iterations * step->record.contacts;
  }
  if (visits > 0.0)
    to.push_back(
        measurement_of(group, "solve per iteration and contact", "ns", {1e9 * solve / visits}));
}

}  // namespace

std::vector<BenchStep> measure_steps(const Scene& scene, BenchStart start, long steps,
                                     int threads) {
  StepSettings settings = step_settings(scene);
  settings.solver.threads = threads;
  TimeStepper stepper(start.system, settings, start.system.first_driven_wall());
  std::vector<BenchStep> result;
  for (long k = 0; k < steps; ++k) {
    const double begin = cpu_seconds();
    BenchStep step;
    step.record = stepper.step(start.state, start.memory);
    step.cpu_seconds = cpu_seconds() - begin;
    step.counters = stepper.detection_counters();
    result.push_back(step);
  }
  return result;
}

std::vector<Measurement> step_measurements(const Scene& scene, const std::vector<BenchStep>& steps,
                                           int threads) {
  std::vector<const BenchStep*> all, active, passive, jammed;
  double fastest = 0.0;
  // As the wall's cycles have it: what is slow beside the fastest of these steps is jammed.
  for (const BenchStep& step : steps) fastest = std::max(fastest, std::abs(step.record.wall_v));
  for (const BenchStep& step : steps) {
    all.push_back(&step);
    const double v = step.record.wall_v;
    (std::abs(v) <= WallSettings{}.jammed_speed * fastest ? jammed
     : v > 0.0                                            ? active
                                                          : passive)
        .push_back(&step);
  }
  const double scale = step_settings(scene).velocity_scale();
  const std::string prefix = std::to_string(threads) + (threads == 1 ? " thread, " : " threads, ");
  std::vector<Measurement> result;
  add_group(prefix + "all", all, scale, result);
  add_group(prefix + "passive", passive, scale, result);
  add_group(prefix + "jammed", jammed, scale, result);
  add_group(prefix + "active", active, scale, result);
  return result;
}

Figure step_figure(const std::vector<BenchStep>& steps, int windows) {
  constexpr Ink inks[] = {Ink::vermilion, Ink::orange, Ink::blue, Ink::green, Ink::sky, Ink::grey};
  Figure figure;
  figure.name = "step";
  figure.title = "Where the time of a step goes";
  figure.height = 620;
  figure.panels.resize(2);
  // Windows of equal length, each a point of the figure: the median of its steps.
  const size_t length =
      std::max<size_t>(1, steps.size() / static_cast<size_t>(std::max(1, windows)));
  const auto medians = [&](const auto& value) {
    Curve curve;
    for (size_t begin = 0; begin + length <= steps.size(); begin += length) {
      std::vector<double> values;
      for (size_t k = begin; k < begin + length; ++k) values.push_back(value(steps[k].record));
      curve.x.push_back(steps[begin + length / 2].record.time);
      curve.y.push_back(measurement_of("", "", "", std::move(values)).median);
    }
    return curve;
  };
  for (const StepColumn& phase : step_phases()) {
    Curve curve = medians([&](const StepRecord& r) { return 1e3 * (r.*phase.value); });
    curve.title = phase.phase_word();
    curve.ink = inks[figure.panels[0].curves.size() % std::size(inks)];
    figure.panels[0].curves.push_back(std::move(curve));
  }
  figure.panels[0].y_label = "time of a step [ms]";
  figure.panels[0].y_min = 0.0;
  Curve wall = medians([](const StepRecord& r) { return r.wall_v; });
  wall.ink = Ink::black;
  figure.panels[1].curves.push_back(std::move(wall));
  figure.panels[1].y_label = "wall, outward [m/s]";
  figure.panels[0].x_label = figure.panels[1].x_label = "simulated time [s]";
  return figure;
}

}  // namespace ballast
