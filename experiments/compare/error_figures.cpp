// Error against time, case by case and over families.

#include <algorithm>
#include <cmath>
#include <set>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/page/page.hpp"

namespace ballast {
namespace {

std::vector<std::string> solvers_of(std::span<const CompareRow> rows) {
  std::vector<std::string> names;
  for (const CompareRow& row : rows)
    if (std::find(names.begin(), names.end(), row.solver) == names.end())
      names.push_back(row.solver);
  return names;
}

/// Rows of the first repeat, from `start`.
template <typename Test>
std::vector<const CompareRow*> selected(std::span<const CompareRow> rows, StartKind start,
                                        Test&& test) {
  std::vector<const CompareRow*> found;
  for (const CompareRow& row : rows)
    if (row.start == start && row.repeat == 0 && test(row)) found.push_back(&row);
  return found;
}

/// The history to the tightest tolerance that has one.
const CompareRow* longest_history(const std::vector<const CompareRow*>& rows,
                                  const std::string& solver) {
  const CompareRow* best = nullptr;
  for (const CompareRow* row : rows)
    if (row->solver == solver && !row->history.empty() &&
        (!best || row->tolerance < best->tolerance))
      best = row;
  return best;
}

/// Where a solver arrived: one point per tolerance that it solved.
Curve arrivals(const std::vector<const CompareRow*>& rows, const std::string& solver, Curve curve) {
  curve.mark = Mark::points;
  curve.width = 2.4;
  curve.title.clear();
  for (const CompareRow* row : rows) {
    if (row->solver != solver || row->verdict != Verdict::solved || !(row->natural_map_rms > 0.0))
      continue;
    curve.x.push_back(row->seconds());
    curve.y.push_back(row->natural_map_rms / row->facts.velocity_scale);
  }
  return curve;
}

Panel error_panel() {
  Panel panel;
  panel.x_label = "time  (s)";
  panel.y_label = "error, relative";
  panel.log_x = panel.log_y = true;
  return panel;
}

void mark_tolerances(const std::vector<const CompareRow*>& rows, Panel& panel) {
  if (rows.empty() || rows[0]->measure != Measure::natural_map) return;
  std::set<double> tolerances;
  for (const CompareRow* row : rows) tolerances.insert(row->tolerance);
  for (const double tolerance : tolerances)
    panel.lines.push_back({tolerance, "", false, Ink::grey});
}

/// What a log axis cannot show: errors far below rounding flatten the picture.
void bound_errors(Panel& panel) {
  double least = infinity, most = 0.0;
  for (const Curve& curve : panel.curves)
    for (const double y : curve.y)
      if (y > 0.0 && std::isfinite(y)) {
        least = std::min(least, y);
        most = std::max(most, y);
      }
  if (least < 1e-16 && most > 1e-16) panel.y_min = 1e-16;
}

Figure figure_of(const std::string& name, const std::string& title, Panel panel) {
  Figure figure;
  figure.name = name;
  figure.title = title;
  figure.height = height_for(panel.curves.size() / 2);
  if (!panel.curves.empty()) {
    bound_errors(panel);
    figure.panels = {std::move(panel)};
  }
  return figure;
}

}  // namespace

page::Picture work_precision_figure(std::span<const CompareRow> rows, const std::string& case_name,
                                    StartKind start) {
  const std::vector<const CompareRow*> mine =
      selected(rows, start, [&](const CompareRow& row) { return row.case_name == case_name; });
  const std::vector<std::string> solvers = solvers_of(rows);
  Panel panel = error_panel();
  for (size_t s = 0; s < solvers.size(); ++s) {
    const Curve style = backend_curve(s, solvers[s]);
    bool is_drawn = false;
    if (const CompareRow* row = longest_history(mine, solvers[s])) {
      StepCurve best = best_so_far(*row);
      thin_out(best.x, best.y, 200);
      if (best.x.size() > 1) {
        Curve curve = stairs(best, std::max(best.x.back(), row->seconds()), style);
        panel.curves.push_back(std::move(curve));
        is_drawn = true;
      }
    }
    Curve points = arrivals(mine, solvers[s], style);
    if (points.x.empty()) continue;
    if (!is_drawn) points.title = style.title;
    panel.curves.push_back(std::move(points));
  }
  mark_tolerances(mine, panel);
  if (mine.empty()) return {};
  const CaseFacts& facts = mine[0]->facts;
  const page::Text caption =
      page::words("case.caption", {{"case", case_name},
                                   {"start", name_of(start)},
                                   {"contacts", page::exact(facts.contacts)},
                                   {"rank_deficiency", page::number(facts.rank_deficiency, 2)},
                                   {"mass_ratio", page::number(facts.mass_ratio, 2)}});
  return {figure_of("case_" + figure_name(case_name) + "_" + name_of(start),
                    "Error against time: " + case_name, std::move(panel)),
          {caption}};
}

page::Picture family_figure(std::span<const CompareRow> rows, const std::string& family,
                            StartKind start) {
  const std::vector<const CompareRow*> mine =
      selected(rows, start, [&](const CompareRow& row) { return row.family == family; });
  std::set<std::string> cases;
  for (const CompareRow* row : mine) cases.insert(row->case_name);
  const std::vector<std::string> solvers = solvers_of(rows);
  Panel panel = error_panel();
  for (size_t s = 0; cases.size() > 1 && s < solvers.size(); ++s) {
    std::vector<StepCurve> curves;
    for (const std::string& name : cases) {
      std::vector<const CompareRow*> of_case;
      for (const CompareRow* row : mine)
        if (row->case_name == name) of_case.push_back(row);
      if (const CompareRow* row = longest_history(of_case, solvers[s]))
        curves.push_back(best_so_far(*row));
    }
    if (curves.size() < cases.size()) continue;  // a mean over other cases would not compare
    double first = infinity, last = 0.0;
    for (const StepCurve& curve : curves)
      for (const double x : curve.x)
        if (x > 0.0) {
          first = std::min(first, x);
          last = std::max(last, x);
        }
    if (!(last > first)) continue;
    Curve curve = backend_curve(s, solvers[s]);
    constexpr int samples = 160;
    for (int k = 0; k <= samples; ++k)
      curve.x.push_back(first * std::pow(last / first, static_cast<double>(k) / samples));
    curve.y = mean_error_at(curves, curve.x);
    panel.curves.push_back(std::move(curve));
  }
  mark_tolerances(mine, panel);
  const page::Text caption =
      page::words("family.caption", {{"family", family},
                                     {"cases", page::exact(static_cast<double>(cases.size()))},
                                     {"start", name_of(start)}});
  return {figure_of("family_" + figure_name(family) + "_" + name_of(start),
                    "Error against time: family " + family, std::move(panel)),
          {caption}};
}

}  // namespace ballast
