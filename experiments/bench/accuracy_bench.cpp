#include "experiments/bench/accuracy_bench.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/compare/live_page.hpp"

namespace ballast {
namespace {

double number_of(const char* name, const Trajectory& trajectory, const LiveComparison& comparison) {
  const std::string wanted = name;
  for (const LiveNumber& number : live_numbers())
    if (number.name == wanted) return number.of(trajectory, comparison);
  return not_known;
}

/// Wall clock of a simulated second [s].
double cost_of(const Trajectory& trajectory, const LiveComparison& comparison) {
  return 1e-3 * number_of("ms_per_step", trajectory, comparison) / comparison.scene.step;
}

}  // namespace

LiveComparison measure_accuracy(const LiveOptions& live, const std::vector<int>& iterations,
                                const std::function<bool(const Trajectory&)>& said) {
  LiveComparison all;
  bool goes_on = true;
  const auto run = [&](const LiveOptions& options) {
    if (!goes_on) return;
    std::vector<Trajectory> before = std::move(all.trajectories);
    all = run_live(options, [&](const Trajectory& t) { return goes_on = said(t); });
    all.trajectories.insert(all.trajectories.begin(), std::make_move_iterator(before.begin()),
                            std::make_move_iterator(before.end()));
  };
  if (!live.tolerances.empty()) run(live);
  for (const int count : iterations) {
    LiveOptions options = live;
    options.max_iterations = count;
    options.tolerances = {1e-12};  // never reached: every step gets all of them
    run(options);
  }
  all.reference = -1;
  double least = HUGE_VAL;
  for (size_t k = 0; k < all.trajectories.size(); ++k) {
    const double error = number_of("error_mean", all.trajectories[k], all);
    if (!all.trajectories[k].is_complete() || !(error < least)) continue;
    least = error;
    all.reference = static_cast<int>(k);
  }
  return all;
}

std::vector<Measurement> accuracy_measurements(const LiveComparison& comparison) {
  std::vector<Measurement> result;
  for (const Trajectory& t : comparison.trajectories) {
    if (!t.is_complete()) continue;
    result.push_back(
        measurement_of(t.label(), "cost of a simulated second", "s", {cost_of(t, comparison)}));
    for (const LiveNumber& number : live_numbers())
      if (const double value = number.of(t, comparison); std::isfinite(value))
        result.push_back(measurement_of(t.label(), number.name, number.unit, {value}));
  }
  return result;
}

Figure accuracy_figure(const LiveComparison& comparison) {
  Panel panel{.x_label = "cost of a simulated second [s]",
              .y_label = "error, mean over steps [g h]",
              .log_x = true,
              .log_y = true};
  std::map<std::string, std::vector<std::pair<double, double>>> lines;
  for (const Trajectory& t : comparison.trajectories)
    if (const double error = number_of("error_mean", t, comparison); t.is_complete() && error > 0.0)
      lines[t.solver].emplace_back(cost_of(t, comparison), error);
  for (auto& [solver, points] : lines) {
    std::sort(points.begin(), points.end());
    add_marked_line(points, backend_curve(panel.curves.size() / 2, solver), panel);
  }
  panel.lines.push_back({1e-3, "1e-3", false, Ink::grey});
  return {.name = "accuracy",
          .title = "Error against the cost of a simulated second",
          .panels = {panel}};
}

}  // namespace ballast
