// Figures that say whether a run can be trusted, and what it cost.

#include <algorithm>
#include <cmath>

#include "experiments/run_page/figures.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

bool is_zero(const RunData& data, double StepRecord::*value) {
  return std::all_of(data.steps.begin(), data.steps.end(), [&](const StepRecord& s) {
    return !(s.*value != 0.0) || std::isnan(s.*value);
  });
}

page::Picture error_figure(const RunData& data, const RunSummary& summary) {
  const double scale = summary.facts.velocity_scale;
  const bool is_relative = std::isfinite(scale);
  const double factor = is_relative ? 1.0 / scale : 1.0;
  Panel panel =
      time_panel(data, is_relative ? "error\u00a0/\u00a0{/:Italic gh}" : "error  (m/s)", true);
  panel.curves = {
      column_line(data, &StepRecord::error_max, factor, "worst contact", Ink::light, 0.8),
      column_line(data, &StepRecord::error_rms, factor, "rms over contacts", Ink::blue, 1.4)};
  const double tolerance = summary.facts.tolerance;
  if (is_relative && std::isfinite(tolerance))
    panel.lines = {{tolerance, printed("%g: tolerance", tolerance), false, Ink::grey}};
  page::Text caption = page::words("run.error");
  caption += page::words(is_relative ? "run.error.relative" : "run.error.absolute",
                         {{"scale", page::quantity(scale, "m/s")},
                          {"mean", page::number(summary.error_mean_relative)},
                          {"max", page::number(summary.error_max_relative)}});
  if (is_relative && *summary.facts.has_packing) caption += page::words("run.error.box");
  return run_picture("error", 420, {panel}, caption);
}

page::Picture penetration_figure(const RunData& data, const RunSummary& summary) {
  Panel panel = time_panel(data, "overlap  (µm)", true);
  panel.curves = {
      column_line(data, &StepRecord::penetration_max, 1e6, "deepest", Ink::vermilion, 1.4),
      column_line(data, &StepRecord::penetration_mean, 1e6, "mean over active contact points",
                  Ink::blue, 1.4)};
  if (*summary.facts.has_packing)
    panel.lines = {
        {1e6 * target::penetration_max, "250 µm: bound on the deepest", false, Ink::grey},
        {1e6 * target::penetration_mean, "5 µm: bound on the mean", false, Ink::grey}};
  // the axis ends at the decade below nearly all means
  std::vector<double> means = panel.curves[1].y;
  std::erase_if(means, [](double value) { return !(value > 0.0); });
  if (const double least = quantile(means, 0.02); std::isfinite(least))
    panel.y_min = std::pow(10.0, std::floor(std::log10(std::min(least, 1.0))));
  return run_picture("penetration", 420, {panel},
                     page::words("run.penetration",
                                 {{"deepest", page::quantity(1e6 * summary.penetration_max, "µm")},
                                  {"time", page::quantity(summary.penetration_max_time, "s")},
                                  {"mean", page::quantity(1e6 * summary.penetration_mean, "µm")}}));
}

page::Picture effort_figure(const RunData& data, const RunSummary& summary) {
  Panel above = time_panel(data, "iterations"), below = time_panel(data, "contact points");
  above.curves = {column_line(data, &StepRecord::iterations, 1.0, "", Ink::blue, 1.0)};
  below.curves = {
      column_line(data, &StepRecord::contacts, 1.0, "given to the solver", Ink::grey, 1.3),
      column_line(data, &StepRecord::active_contacts, 1.0, "with an impulse", Ink::green, 1.3)};
  above.y_min = below.y_min = 0.0;
  return run_picture(
      "effort", 540, {above, below},
      page::words("run.effort", {{"mean", page::number(summary.iterations.mean)},
                                 {"most", page::exact(summary.iterations.max)},
                                 {"given", page::number(summary.contacts.mean, 4)},
                                 {"active", page::number(summary.active_contacts.mean, 4)}}));
}

/// Stretches of the run over which the cost is averaged.
constexpr size_t cost_stretches = 250;

/// Sums of the phases, one above the other, averaged over stretches of the run.
std::vector<Curve> stacked_cost(const RunData& data, const RunSummary& summary) {
  constexpr Ink inks[] = {Ink::orange, Ink::green, Ink::blue, Ink::purple, Ink::sky, Ink::light};
  const size_t count = data.steps.size(), bins = std::min(cost_stretches, count);
  // each stretch is drawn at its middle, the outer two at the ends of the axis
  std::vector<double> time(bins), low(bins, 0.0);
  for (size_t b = 0; b < bins; ++b)
    time[b] = data.steps[(b * count / bins + (b + 1) * count / bins) / 2].time;
  time.front() = 0.0;
  time.back() = data.steps.back().time;
  std::vector<Curve> curves;
  for (size_t p = 0; p < summary.cost.size(); ++p) {
    if (!(summary.cost[p].ms_per_step > 0.0)) continue;
    Curve curve{.x = time,
                .title = summary.cost[p].name,
                .ink = inks[p % std::size(inks)],
                .mark = Mark::area,
                .y_low = low};
    // `low` becomes the top of this phase, and so the ground of the next
    for (size_t b = 0; b < bins; ++b) {
      std::vector<double> values;
      for (size_t k = b * count / bins; k < (b + 1) * count / bins; ++k)
        values.push_back(1e3 * (data.steps[k].*summary.cost[p].seconds));
      const double mean = statistics(values).mean;
      curve.y.push_back(low[b] += std::isfinite(mean) ? mean : 0.0);
    }
    curves.push_back(curve);
  }
  return curves;
}

page::Picture cost_figure(const RunData& data, const RunSummary& summary) {
  Panel panel = time_panel(data, "wall clock  (ms per step)");
  panel.curves = stacked_cost(data, summary);
  panel.y_min = 0.0;
  const double stretch =
      summary.duration / static_cast<double>(std::min(cost_stretches, data.steps.size()));
  return run_picture(
      "cost", 460, {panel},
      page::words("run.cost", {{"stretch", page::quantity(1e3 * stretch, "ms")},
                               {"step", page::quantity(summary.ms_per_step, "ms")}}));
}

/// Change of kinetic energy − works + dissipation since the first step, without its sign.
std::vector<double> balance_residual(const std::vector<StepRecord>& steps) {
  std::vector<double> residual(steps.size(), 0.0);
  for (size_t k = 1; k < steps.size(); ++k) {
    const StepRecord& step = steps[k];
    residual[k] = residual[k - 1] + step.kinetic_energy - steps[k - 1].kinetic_energy -
                  step.work_load - step.work_gravity - step.work_prescribed + step.dissipated;
  }
  for (double& value : residual) value = std::abs(value);
  return residual;
}

page::Picture energy_figure(const RunData& data, const RunSummary& summary) {
  const auto time = record_column(data.steps, &StepRecord::time);
  Panel above = time_panel(data, "cumulative energy  (J)"),
        below = time_panel(data, "energy  (J)", true);
  const auto add_sum = [&](double StepRecord::*value, const char* title, Ink ink) {
    if (is_zero(data, value)) return;
    auto sums = record_column(data.steps, value);
    for (size_t k = 1; k < sums.size(); ++k) sums[k] += sums[k - 1];
    above.curves.push_back(line_of(time, sums, title, ink, 1.8));
  };
  add_sum(&StepRecord::work_load, "work of the load", Ink::blue);
  add_sum(&StepRecord::work_gravity, "of gravity", Ink::green);
  add_sum(&StepRecord::work_prescribed, "of walls and forces", Ink::orange);
  add_sum(&StepRecord::dissipated, "dissipated", Ink::vermilion);
  below.curves = {
      column_line(data, &StepRecord::kinetic_energy, 1.0, "kinetic energy", Ink::black, 1.4),
      line_of(time, balance_residual(data.steps), "|residual of the balance|", Ink::purple, 1.4)};
  std::vector<Panel> panels{below};
  if (!above.curves.empty()) panels.insert(panels.begin(), above);
  return run_picture(
      "energy", 580, panels,
      page::words("run.energy", {{"residual", page::quantity(summary.energy.residual, "J")},
                                 {"relative", page::number(summary.energy.relative)}}));
}

}  // namespace

std::vector<page::Picture> diagnostic_figures(const RunData& data, const RunSummary& summary) {
  std::vector<page::Picture> figures;
  if (summary.wall.loop_first < summary.wall.loop_last && *summary.facts.has_packing)
    figures.push_back(jammed_figure(data, summary));
  figures.push_back(error_figure(data, summary));
  // a scene without any overlap has no logarithm of it to show
  if (summary.penetration_max > 0.0) figures.push_back(penetration_figure(data, summary));
  figures.push_back(effort_figure(data, summary));
  if (summary.ms_per_step > 0.0) figures.push_back(cost_figure(data, summary));
  figures.push_back(energy_figure(data, summary));
  return figures;
}

}  // namespace ballast
