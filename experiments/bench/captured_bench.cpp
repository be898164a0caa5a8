#include "experiments/bench/captured_bench.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/measure/curve_fit.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

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

std::vector<SolveGroup> grouped(std::span<const CompareRow> rows) {
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

std::vector<Measurement> captured_measurements(std::span<const CompareRow> rows,
                                               std::span<const double> within) {
  std::vector<Measurement> result;
  for (const SolveGroup& group : grouped(rows)) {
    const std::string name =
        printed("%s, %s, %g", group.solver.c_str(), name_of(group.start), group.tolerance);
    const std::vector<double> costs = group.costs();
    const auto add = [&](const std::string& what, const char* unit, std::vector<double> values) {
      if (!values.empty()) result.push_back(measurement_of(name, what, unit, std::move(values)));
    };
    add("solved", "problems", {static_cast<double>(costs.size())});
    for (const double limit : within)
      add(printed("solved within %g s", limit), "problems",
          {static_cast<double>(
              std::ranges::count_if(costs, [&](double s) { return s <= limit; }))});
    add("cost", "s", costs);
    for (const RowMeasure& measure : row_measures)
      add(measure.name, measure.unit, group.values(measure));
  }
  return result;
}

Figure captured_figure(std::span<const CompareRow> rows) {
  Figure figure{.name = "captured", .title = "Every measure of an answer's error against its cost"};
  const std::vector<SolveGroup> groups = grouped(rows);
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
