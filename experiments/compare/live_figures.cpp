#include "experiments/compare/live_figures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/compare/compare_figures.hpp"
#include "experiments/page/page.hpp"

namespace ballast {
namespace {

using Values = std::vector<double>;

/// A backend's colour; the tightest tolerance is a whole line, looser ones have shorter dashes.
Curve trajectory_curve(const LiveComparison& comparison, const Trajectory& trajectory) {
  std::vector<std::string> solvers;
  std::vector<double> tolerances;
  for (const Trajectory& t : comparison.trajectories) {
    if (std::find(solvers.begin(), solvers.end(), t.solver) == solvers.end())
      solvers.push_back(t.solver);
    if (std::find(tolerances.begin(), tolerances.end(), t.tolerance) == tolerances.end())
      tolerances.push_back(t.tolerance);
  }
  std::sort(tolerances.begin(), tolerances.end());
  const auto place = [](const auto& values, const auto& value) {
    return static_cast<size_t>(std::find(values.begin(), values.end(), value) - values.begin());
  };
  Curve curve = backend_curve(place(solvers, trajectory.solver), trajectory.label());
  const size_t looseness = place(tolerances, trajectory.tolerance);
  curve.dashed = looseness > 0;
  curve.fineness = static_cast<int>(std::clamp<size_t>(looseness, 1, 3)) - 1;
  curve.width = looseness == 0 ? 2.0 : 1.6;
  curve.origins = {trajectory.label()};
  return curve;
}

/// One figure with a line for every trajectory.
struct LiveFigure {
  const char *name, *title, *y_label;
  bool log_y;
};

template <typename ValuesOf>
page::Picture lines_figure(const LiveComparison& comparison, const LiveFigure& what,
                           ValuesOf&& values_of, const page::Values& values = {}) {
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
    Curve curve = trajectory_curve(comparison, t);
    curve.x = std::move(x);
    curve.y = std::move(y);
    panel.curves.push_back(std::move(curve));
  }
  Figure figure;
  figure.name = what.name;
  figure.title = what.title;
  figure.height = height_for(2 * panel.curves.size());
  if (!panel.curves.empty()) figure.panels = {std::move(panel)};
  return {figure, {page::words(std::string(what.name) + ".caption", values)}};
}

page::Picture column_figure(const LiveComparison& comparison, const LiveFigure& what,
                            double StepRecord::*value, double factor) {
  return lines_figure(comparison, what, [&](const Trajectory& t, Values& x, Values& y) {
    for (const StepRecord& s : t.steps) {
      if (!std::isfinite(s.*value)) continue;
      x.push_back(s.time);
      y.push_back(factor * (s.*value));
    }
  });
}

page::Picture cost_figure(const LiveComparison& comparison) {
  return lines_figure(comparison, {"live_cost", "Cost", "wall clock of the solver  (s)", false},
                      [](const Trajectory& t, Values& x, Values& y) {
                        double sum = 0.0;
                        for (const StepRecord& s : t.steps) {
                          x.push_back(s.time);
                          sum += s.seconds_solve;
                          y.push_back(sum);
                        }
                      });
}

/// The wall's distance from where it is in the reference solution: the trajectories themselves
/// coincide to the eye.
page::Picture wall_deviation_figure(const LiveComparison& comparison) {
  if (comparison.reference < 0) return {};
  const Trajectory& reference = comparison.trajectories[static_cast<size_t>(comparison.reference)];
  return lines_figure(
      comparison,
      {"live_wall_deviation", "Deviation of the wall", "|{/:Italic x} − {/:Italic x}_{ref}|  (µm)",
       true},
      [&](const Trajectory& t, Values& x, Values& y) {
        for (size_t k = 0; &t != &reference && k < std::min(t.steps.size(), reference.steps.size());
             ++k) {
          x.push_back(t.steps[k].time);
          y.push_back(1e6 * std::abs(t.steps[k].wall_x - reference.steps[k].wall_x));
        }
      });
}

page::Picture distance_figure(const LiveComparison& comparison) {
  if (comparison.reference < 0) return {};
  const Trajectory& reference = comparison.trajectories[static_cast<size_t>(comparison.reference)];
  return lines_figure(comparison,
                      {"live_distance", "Distance from the reference", "rms distance  (µm)", true},
                      [&](const Trajectory& t, Values& x, Values& y) {
                        if (&t == &reference) return;
                        y = distances(t, reference);
                        for (double& d : y) d *= 1e6;
                        x.assign(t.frame_times.begin(),
                                 t.frame_times.begin() + static_cast<std::ptrdiff_t>(y.size()));
                      },
                      {{"reference", reference.label()}});
}

}  // namespace

std::vector<page::Picture> live_figures(const LiveComparison& comparison) {
  std::vector<page::Picture> figures;
  if (comparison.has_driven_wall) {
    figures.push_back(column_figure(
        comparison, {"live_wall", "Wall trajectory", "wall {/:Italic x}  (mm)", false},
        &StepRecord::wall_x, 1e3));
    figures.push_back(wall_deviation_figure(comparison));
    figures.push_back(
        column_figure(comparison, {"live_force", "Force on the wall", "{/:Italic f_g}  (N)", false},
                      &StepRecord::wall_force, 1.0));
  }
  figures.push_back(distance_figure(comparison));
  figures.push_back(
      column_figure(comparison, {"live_error", "Error of the contact law", "error, relative", true},
                    &StepRecord::error_rms, 1.0 / comparison.velocity_scale));
  figures.push_back(column_figure(
      comparison, {"live_penetration", "Deepest overlap", "deepest overlap  (µm)", true},
      &StepRecord::penetration_max, 1e6));
  figures.push_back(column_figure(comparison,
                                  {"live_energy", "Kinetic energy", "kinetic energy  (J)", true},
                                  &StepRecord::kinetic_energy, 1.0));
  figures.push_back(
      column_figure(comparison, {"live_solid_fraction", "Solid fraction", "solid fraction", false},
                    &StepRecord::solid_fraction, 1.0));
  figures.push_back(cost_figure(comparison));
  return figures;
}

}  // namespace ballast
