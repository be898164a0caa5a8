#include "experiments/bench/accuracy_bench.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/compare/live_page.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "platform/text.hpp"

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

/// What may be drawn over the cost; NaN: not known of this row.
struct RowMeasure {
  const char *name, *unit, *label;
  double (*of)(const CompareRow&);
};
const RowMeasure row_measures[] = {
    {"error rms", "g h", "error [g h]", [](const CompareRow& r) { return r.error; }},
    {"distance of velocities", "g h", "bodies off [g h]",
     [](const CompareRow& r) { return r.distance.velocity; }},
    {"distance of contact velocities", "g h", "contacts off [g h]",
     [](const CompareRow& r) { return r.distance.contact_velocity; }},
    {"distance of body impulses", "1", "impulses off [1]",
     [](const CompareRow& r) { return r.distance.body_impulse; }},
    {"distance of the wall's force", "1", "wall force off [1]",
     [](const CompareRow& r) { return r.distance.wall_force; }},
    {"wrong statuses", "1", "statuses off [1]",
     [](const CompareRow& r) {
       return r.distance.statuses < 0 ? not_known : 1.0 * r.distance.statuses / r.facts.contacts;
     }},
};

/// Adds to a panel a line through `points` (x, y) in the style of `curve`, and a mark on each.
void add_marked_line(const std::vector<std::pair<double, double>>& points, Curve curve,
                     Panel& panel) {
  for (const auto& [x, y] : points) curve.add(x, y);
  panel.curves.push_back(curve);
  curve.title = {};
  curve.mark = Mark::points;
  panel.curves.push_back(std::move(curve));
}

/// One solver from one start to one tolerance, on all problems.
struct SolveGroup {
  std::string solver;
  StartKind start;
  double tolerance;
  std::vector<const CompareRow*> rows = {};

  /// Of what is solved, sorted.
  std::vector<double> costs() const {
    std::vector<double> costs;
    for (const CompareRow* row : rows)
      if (row->verdict == Verdict::solved) costs.push_back(row->seconds());
    std::sort(costs.begin(), costs.end());
    return costs;
  }
  std::vector<double> values(const RowMeasure& measure) const {
    std::vector<double> values;
    for (const CompareRow* row : rows)
      if (const double value = measure.of(*row); std::isfinite(value)) values.push_back(value);
    return values;
  }
};

std::vector<SolveGroup> solve_groups(std::span<const CompareRow> rows) {
  std::vector<SolveGroup> groups;
  for (const CompareRow& row : rows) {
    if (row.verdict == Verdict::unreadable) continue;
    auto found = std::ranges::find_if(groups, [&](const SolveGroup& g) {
      return g.solver == row.solver && g.start == row.start && g.tolerance == row.tolerance;
    });
    if (found == groups.end()) found = groups.insert(found, {row.solver, row.start, row.tolerance});
    found->rows.push_back(&row);
  }
  return groups;
}

}  // namespace

LiveComparison measure_accuracy(const LiveOptions& live,
                                const std::function<bool(const Trajectory&)>& said) {
  LiveComparison all = run_live(live, said);
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

std::vector<Measurement> captured_measurements(std::span<const CompareRow> rows) {
  std::vector<Measurement> result;
  for (const SolveGroup& group : solve_groups(rows)) {
    const std::string name =
        printed("%s, %s, %g", group.solver.c_str(), name_of(group.start), group.tolerance);
    const std::vector<double> costs = group.costs();
    const auto add = [&](const std::string& what, const char* unit, std::vector<double> values) {
      if (!values.empty()) result.push_back(measurement_of(name, what, unit, std::move(values)));
    };
    add("solved", "problems", {static_cast<double>(costs.size())});
    add("cost", "s", costs);
    for (const RowMeasure& measure : row_measures)
      add(measure.name, measure.unit, group.values(measure));
  }
  return result;
}

Figure captured_figure(std::span<const CompareRow> rows) {
  Figure figure{.name = "captured", .title = "Every measure of an answer's error against its cost"};
  const std::vector<SolveGroup> groups = solve_groups(rows);
  std::vector<std::string> solvers;
  for (const SolveGroup& group : groups)
    if (std::ranges::find(solvers, group.solver) == solvers.end()) solvers.push_back(group.solver);
  for (const RowMeasure& measure : row_measures) {
    Panel panel{.x_label = "cost of a solve, median over problems [s]",
                .y_label = measure.label,
                .log_x = true,
                .log_y = true};
    for (size_t k = 0; k < solvers.size(); ++k)
      for (const StartKind start : {StartKind::warm, StartKind::cold}) {
        std::vector<std::pair<double, double>> points;
        for (const SolveGroup& group : groups) {
          if (group.solver != solvers[k] || group.start != start) continue;
          // The median over all problems: what is not solved costs more than any that is.
          const std::vector<double> costs = group.costs();
          const size_t middle = (group.rows.size() - 1) / 2;
          const double y = quantile(group.values(measure), 0.5);
          if (middle < costs.size() && y > 0.0) points.emplace_back(costs[middle], y);
        }
        if (points.empty()) continue;
        const bool is_first = figure.panels.empty();
        Curve line = backend_curve(k, is_first ? solvers[k] + ", " + name_of(start) : "");
        line.dashed = start == StartKind::cold;
        add_marked_line(points, line, panel);
      }
    if (!panel.curves.empty()) figure.panels.push_back(std::move(panel));
  }
  figure.height = 60 + 170 * static_cast<int>(figure.panels.size());
  return figure;
}

}  // namespace ballast
