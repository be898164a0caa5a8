#include "experiments/bench/accuracy_bench.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/step/step_record.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

AccuracyRow row_of(const Trajectory& trajectory, double scale) {
  AccuracyRow row;
  row.solver = trajectory.solver;
  row.limit = trajectory.max_iterations > 0 ? printed("%d iterations", trajectory.max_iterations)
                                            : printed("tolerance %g", trajectory.tolerance);
  row.complete = trajectory.is_complete();
  double seconds = 0.0;
  for (const StepRecord& s : trajectory.steps) {
    seconds += step_seconds(s);
    row.error_mean += s.error_rms / scale;
    row.error_worst = std::max(row.error_worst, s.error_rms / scale);
    row.iterations += s.iterations;
    row.penetration = std::max(row.penetration, s.penetration_max);
  }
  const double steps = static_cast<double>(trajectory.steps.size());
  if (steps > 1.0) {
    // Times are the ends of steps: from the first to the last there is one step less than all.
    const double simulated =
        (trajectory.steps.back().time - trajectory.steps.front().time) * steps / (steps - 1.0);
    row.seconds_per_second = seconds / simulated;
    row.error_mean /= steps;
    row.iterations /= steps;
  }
  row.distance = std::nan("");
  return row;
}

/// Of the complete trajectories; rows.size() when there is none.
size_t least_error(const std::vector<AccuracyRow>& rows) {
  size_t best = rows.size();
  for (size_t k = 0; k < rows.size(); ++k)
    if (rows[k].complete && (best == rows.size() || rows[k].error_mean < rows[best].error_mean))
      best = k;
  return best;
}

}  // namespace

std::vector<AccuracyRow> measure_accuracy(const AccuracyOptions& options,
                                          const std::function<bool(const Trajectory&)>& said) {
  std::vector<Trajectory> trajectories;
  double scale = 1.0;
  bool goes_on = true;
  const auto heard = [&](const Trajectory& t) { return goes_on = said(t); };
  const auto run = [&](const LiveOptions& live) {
    if (!goes_on) return;
    LiveComparison comparison = run_live(live, heard);
    scale = comparison.velocity_scale;
    for (Trajectory& t : comparison.trajectories) trajectories.push_back(std::move(t));
  };
  // First to tolerances, with as many iterations as that takes; then by number of iterations.
  if (!options.live.tolerances.empty()) run(options.live);
  for (const int iterations : options.iterations) {
    LiveOptions live = options.live;
    live.max_iterations = iterations;
    live.tolerances = {1e-12};  // never reached: every step gets all of them
    run(live);
  }
  std::vector<AccuracyRow> rows;
  for (const Trajectory& t : trajectories) rows.push_back(row_of(t, scale));
  // The most exact trajectory is what the others are compared with.
  const size_t best = least_error(rows);
  for (size_t k = 0; k < rows.size() && best < rows.size(); ++k) {
    const std::vector<double> d = distances(trajectories[k], trajectories[best]);
    if (!d.empty()) rows[k].distance = d.back();
  }
  return rows;
}

std::vector<Measurement> accuracy_measurements(const std::vector<AccuracyRow>& rows) {
  std::vector<Measurement> result;
  for (const AccuracyRow& row : rows) {
    if (!row.complete) continue;
    const std::string group = row.solver + ", " + row.limit;
    const auto add = [&](const char* name, const char* unit, double value) {
      if (std::isfinite(value)) result.push_back(measurement_of(group, name, unit, {value}));
    };
    add("cost of a simulated second", "s", row.seconds_per_second);
    add("error rms, mean over steps", "g h", row.error_mean);
    add("error rms, worst step", "g h", row.error_worst);
    add("iterations", "iterations", row.iterations);
    add("distance from the reference", "um", 1e6 * row.distance);
    add("penetration max", "um", 1e6 * row.penetration);
  }
  return result;
}

Figure accuracy_figure(const std::vector<AccuracyRow>& rows) {
  const Ink inks[] = {Ink::blue,   Ink::vermilion, Ink::green, Ink::orange,
                      Ink::purple, Ink::sky,       Ink::black};
  Figure figure;
  figure.name = "accuracy";
  figure.title = "Error against the cost of a simulated second";
  figure.panels.resize(1);
  Panel& panel = figure.panels[0];
  panel.x_label = "cost of a simulated second [s]";
  panel.y_label = "error, mean over steps [g h]";
  panel.log_x = panel.log_y = true;
  std::vector<std::string> solvers;
  for (const AccuracyRow& row : rows)
    if (std::find(solvers.begin(), solvers.end(), row.solver) == solvers.end())
      solvers.push_back(row.solver);
  for (size_t k = 0; k < solvers.size(); ++k) {
    std::vector<std::pair<double, double>> points;
    for (const AccuracyRow& row : rows)
      if (row.solver == solvers[k] && row.complete && row.error_mean > 0.0)
        points.emplace_back(row.seconds_per_second, row.error_mean);
    if (points.empty()) continue;
    std::sort(points.begin(), points.end());
    Curve line, marks;
    for (const auto& [x, y] : points) {
      line.x.push_back(x);
      line.y.push_back(y);
    }
    line.title = solvers[k];
    line.ink = inks[k % std::size(inks)];
    marks = line;
    marks.title.clear();
    marks.mark = Mark::points;
    panel.curves.push_back(std::move(line));
    panel.curves.push_back(std::move(marks));
  }
  panel.lines.push_back({1e-3, "1e-3", false, Ink::grey});
  return figure;
}

}  // namespace ballast
