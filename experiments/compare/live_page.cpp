#include "experiments/compare/live_page.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/compare/live_row.hpp"
#include "experiments/compare/page_drawing.hpp"
#include "experiments/page/html.hpp"
#include "experiments/run_page/report_origin.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"

namespace ballast {
namespace {

using Values = std::vector<double>;

Html table_of(const std::vector<LiveRow>& rows, const LiveComparison& comparison) {
  HtmlTable table;
  table.head = {{"backend, tolerance"},
                {"law"},
                {"ended"},
                {"error, mean"},
                {"worst"},
                {"above tolerance"},
                {"wall <i>x</i>"},
                {"mean <i>f</i><sub>g</sub>"},
                {"overlap"},
                {"kinetic energy"},
                {"solid fraction"},
                {"iterations"},
                {"solve per step"},
                {"distance"}};
  table.is_number.assign(table.head.size(), true);
  table.is_number[0] = table.is_number[1] = table.is_number[2] = false;
  for (const LiveRow& r : rows) {
    const bool is_reference =
        comparison.reference >= 0 &&
        r.trajectory == &comparison.trajectories[static_cast<size_t>(comparison.reference)];
    table.rows.push_back(
        {escaped(r.trajectory->label()) + Html{is_reference ? " <b>(reference)</b>" : ""},
         escaped(r.trajectory->law), escaped(r.trajectory->ended), number(r.error_mean),
         number(r.error_max), quantity(100.0 * r.missed, "%"), quantity(1e3 * r.wall_x, "mm", 4),
         quantity(r.force_mean, "N", 4), quantity(1e6 * r.penetration_max, "µm"),
         quantity(r.kinetic_energy, "J"), number(r.solid_fraction, 4), number(r.iterations),
         quantity(r.solve_ms_per_step, "ms"), quantity(1e6 * r.distance, "µm")});
  }
  return to_html(table);
}

/// A backend's colour, thinner for looser tolerances.
Curve line_of(const LiveComparison& comparison, const Trajectory& trajectory) {
  std::vector<std::string> solvers;
  std::vector<double> tolerances;
  for (const Trajectory& t : comparison.trajectories) {
    if (std::find(solvers.begin(), solvers.end(), t.solver) == solvers.end())
      solvers.push_back(t.solver);
    if (std::find(tolerances.begin(), tolerances.end(), t.tolerance) == tolerances.end())
      tolerances.push_back(t.tolerance);
  }
  std::sort(tolerances.rbegin(), tolerances.rend());
  const auto place = [](const auto& values, const auto& value) {
    return std::find(values.begin(), values.end(), value) - values.begin();
  };
  Curve curve = styled(static_cast<size_t>(place(solvers, trajectory.solver)), trajectory.label());
  const double tightness = tolerances.size() < 2
                               ? 1.0
                               : static_cast<double>(place(tolerances, trajectory.tolerance)) /
                                     static_cast<double>(tolerances.size() - 1);
  curve.width = 0.7 + 1.3 * tightness;
  curve.opacity = 0.5 + 0.5 * tightness;
  return curve;
}

/// One figure with a line for every trajectory.
struct LiveFigure {
  const char *name, *title, *y_label;
  bool log_y;
  const char* caption;
};

template <typename ValuesOf>
ReportFigure figure_of(const LiveComparison& comparison, const LiveFigure& what,
                       ValuesOf&& values_of) {
  Panel panel;
  panel.x_label = "{/:Italic t}  (s)";
  panel.y_label = what.y_label;
  panel.log_y = what.log_y;
  for (const Trajectory& t : comparison.trajectories) {
    Values x, y;
    values_of(t, x, y);
    if (std::none_of(y.begin(), y.end(),
                     [&](double v) { return std::isfinite(v) && (!what.log_y || v > 0.0); }))
      continue;
    thin_out(x, y, 1500);
    Curve curve = line_of(comparison, t);
    curve.x = std::move(x);
    curve.y = std::move(y);
    panel.curves.push_back(std::move(curve));
  }
  Figure figure;
  figure.name = what.name;
  figure.title = what.title;
  figure.height = height_for(2 * panel.curves.size());
  if (!panel.curves.empty()) figure.panels = {std::move(panel)};
  return {figure, Html{what.caption}};
}

ReportFigure column_figure(const LiveComparison& comparison, const LiveFigure& what,
                           double StepRecord::*value, double factor) {
  return figure_of(comparison, what, [&](const Trajectory& t, Values& x, Values& y) {
    for (const StepRecord& s : t.steps) {
      if (!std::isfinite(s.*value)) continue;
      x.push_back(s.time);
      y.push_back(factor * (s.*value));
    }
  });
}

ReportFigure cost_figure(const LiveComparison& comparison) {
  return figure_of(comparison,
                   {"live_cost", "Cost", "wall clock of the solver  (s)", false,
                    "<b>Cost</b>: wall clock spent in the solver up to then."},
                   [](const Trajectory& t, Values& x, Values& y) {
                     double sum = 0.0;
                     for (const StepRecord& s : t.steps) {
                       x.push_back(s.time);
                       y.push_back(sum += s.seconds_solve);
                     }
                   });
}

/// The wall's distance from where it is in the reference solution: the trajectories themselves
/// coincide to the eye.
ReportFigure wall_deviation_figure(const LiveComparison& comparison) {
  if (comparison.reference < 0) return {};
  const Trajectory& reference = comparison.trajectories[static_cast<size_t>(comparison.reference)];
  return figure_of(
      comparison,
      {"live_wall_deviation", "Deviation of the wall", "|{/:Italic x} − {/:Italic x}_{ref}|  (µm)",
       true, "<b>Deviation of the driven wall</b> from the reference solution’s."},
      [&](const Trajectory& t, Values& x, Values& y) {
        for (size_t k = 0; &t != &reference && k < std::min(t.steps.size(), reference.steps.size());
             ++k) {
          x.push_back(t.steps[k].time);
          y.push_back(1e6 * std::abs(t.steps[k].wall_x - reference.steps[k].wall_x));
        }
      });
}

ReportFigure distance_figure(const LiveComparison& comparison) {
  if (comparison.reference < 0) return {};
  const Trajectory& reference = comparison.trajectories[static_cast<size_t>(comparison.reference)];
  ReportFigure figure = figure_of(
      comparison, {"live_distance", "Distance from the reference", "rms distance  (µm)", true, ""},
      [&](const Trajectory& t, Values& x, Values& y) {
        if (&t == &reference) return;
        y = distances(t, reference);
        for (double& d : y) d *= 1e6;
        x.assign(t.frame_times.begin(),
                 t.frame_times.begin() + static_cast<std::ptrdiff_t>(y.size()));
      });
  figure.caption = Html{"<b>Distance</b> of the grains’ centres from the reference solution ("} +
                   escaped(reference.label()) +
                   Html{
                       "), rms over grains. <span class=\"look\">Packings are chaotic: that all "
                       "curves grow says little, that the exact law’s fall with "
                       "the tolerance and another law’s do not says much.</span>"};
  return figure;
}

std::vector<ReportFigure> live_figures(const LiveComparison& comparison) {
  std::vector<ReportFigure> figures;
  if (comparison.has_driven_wall) {
    figures.push_back(column_figure(comparison,
                                    {"live_wall", "Wall trajectory", "wall {/:Italic x}  (mm)",
                                     false, "<b>Trajectory of the driven wall.</b>"},
                                    &StepRecord::wall_x, 1e3));
    figures.push_back(wall_deviation_figure(comparison));
    figures.push_back(column_figure(
        comparison,
        {"live_force", "Force on the wall", "{/:Italic f_g}  (N)", false,
         "<b>Force of the grains on the driven wall</b>, mean over each step, not smoothed."},
        &StepRecord::wall_force, 1.0));
  }
  figures.push_back(distance_figure(comparison));
  figures.push_back(
      column_figure(comparison,
                    {"live_error", "Error of the contact law", "error, relative", true,
                     "<b>Error</b> of the exact law per step, by the judge: scaled natural map, "
                     "rms over contacts, over <i>gh</i>."},
                    &StepRecord::error_rms, 1.0 / comparison.velocity_scale));
  figures.push_back(column_figure(comparison,
                                  {"live_penetration", "Deepest overlap", "deepest overlap  (µm)",
                                   true, "<b>Deepest overlap</b> at detection."},
                                  &StepRecord::penetration_max, 1e6));
  figures.push_back(column_figure(comparison,
                                  {"live_energy", "Kinetic energy", "kinetic energy  (J)", true,
                                   "<b>Kinetic energy</b> of grains and driven walls."},
                                  &StepRecord::kinetic_energy, 1.0));
  figures.push_back(column_figure(comparison,
                                  {"live_solid_fraction", "Solid fraction", "solid fraction", false,
                                   "<b>Solid fraction</b> in the control volume."},
                                  &StepRecord::solid_fraction, 1.0));
  figures.push_back(cost_figure(comparison));
  return figures;
}

}  // namespace

void write_live_page(const std::filesystem::path& folder, const LiveComparison& comparison) {
  const std::vector<LiveRow> rows = live_rows(comparison);
  for (const Trajectory& t : comparison.trajectories)
    write_whole_file(folder / ("steps-" + figure_name(t.label()) + ".csv"), steps_csv(t));
  write_whole_file(folder / "live.csv", live_csv(rows));
  const RunData data = read_provenance(folder);
  PageDrawing drawing(folder / "figures");
  const Html figures = drawing.draw(live_figures(comparison));
  const std::string title = "One start, several solvers: " + comparison.scene.name;
  Html body = Html{"<header>\n<h1>"} + escaped(title) + Html{"</h1>\n<p class=\"lede\">"} +
              escaped(made_by(data)) + Html{"</p>\n</header>\n"} + drawing.notices_html();
  body += section("table", "Side by side",
                  Html{"<p>Every backend goes on from the same state, with the same contacts and "
                       "warm start. Errors are over "} +
                      quantity(comparison.velocity_scale, "m/s") +
                      Html{"; distances are rms over grains, at the last common frame, from the "
                           "exact law’s solution at the tightest tolerance.</p>\n"} +
                      table_of(rows, comparison));
  body += section("figures", "Figures", figures);
  body += section("provenance", "Program and machine",
                  Html{page::html_of(page::Block(provenance_table(data)))});
  write_whole_file(folder / "live.html", html_page(title, body));
}

}  // namespace ballast
