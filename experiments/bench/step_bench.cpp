#include "experiments/bench/step_bench.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/wall_cycles.hpp"
#include "experiments/step/step_record.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/clock.hpp"

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
    to.push_back(measurement_of(group, quantity.name, quantity.unit, std::move(values)));
  }
}

}  // namespace

std::vector<BenchStep> measure_steps(const Scene& scene, BenchStart start, long steps,
                                     int threads) {
  Scene threaded = scene;
  threaded.solver.threads = threads;
  TimeStepper stepper(start.system, threaded, start.system.first_driven_wall());
  std::vector<BenchStep> result;
  for (long k = 0; k < steps; ++k) {
    const double begin = processor_seconds();
    BenchStep step;
    step.record = stepper.step(start.state, start.memory);
    step.cpu_seconds = processor_seconds() - begin;
    step.counters = stepper.detection_counters();
    result.push_back(step);
  }
  return result;
}

std::vector<Measurement> step_measurements(const Scene& scene, const std::vector<BenchStep>& steps,
                                           int threads) {
  std::map<std::string, std::vector<const BenchStep*>> groups;
  double fastest = 0.0;
  // As the wall's cycles have it: what is slow beside the fastest of these steps is jammed.
  for (const BenchStep& step : steps) fastest = std::max(fastest, std::abs(step.record.wall_v));
  for (const BenchStep& step : steps) {
    const double v = step.record.wall_v;
    const bool is_jammed = std::abs(v) <= WallSettings{}.jammed_speed * fastest;
    groups["all"].push_back(&step);
    groups[is_jammed ? "jammed" : v > 0.0 ? "active" : "passive"].push_back(&step);
  }
  std::vector<Measurement> result;
  for (const char* name : {"all", "passive", "jammed", "active"})
    add_group(thread_words(threads) + ", " + name, groups[name], velocity_scale(scene), result);
  return result;
}

Figure step_figure(const std::vector<BenchStep>& steps, int windows) {
  Panel phases{.x_label = "simulated time [s]", .y_label = "time of a step [ms]", .y_min = 0.0},
      wall{.x_label = phases.x_label, .y_label = "wall, outward [m/s]"};
  // Windows of equal length, each a point of the figure: the median of its steps.
  const size_t length =
      std::max<size_t>(1, steps.size() / static_cast<size_t>(std::max(1, windows)));
  const auto add = [&](double StepRecord::*column, double factor, Curve curve, Panel& panel) {
    for (size_t begin = 0; begin + length <= steps.size(); begin += length) {
      std::vector<double> values;
      for (size_t k = begin; k < begin + length; ++k)
        values.push_back(factor * (steps[k].record.*column));
      curve.x.push_back(steps[begin + length / 2].record.time);
      curve.y.push_back(quantile(values, 0.5));
    }
    panel.curves.push_back(std::move(curve));
  };
  for (const StepColumn& phase : step_phases())
    add(phase.value, 1e3, backend_curve(phases.curves.size(), phase.phase_word()), phases);
  add(&StepRecord::wall_v, 1.0, {.ink = Ink::black}, wall);
  return {.name = "step",
          .title = "Where the time of a step goes",
          .height = 620,
          .panels = {phases, wall}};
}

}  // namespace ballast
