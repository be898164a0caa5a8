// Figures 3, 4 and 12 of the paper, and what the jammed state tells.

#include <algorithm>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/run_page/figures.hpp"
#include "experiments/step/step_record.hpp"

namespace ballast {
namespace {

/// Samples of one phase in the loop, the others NaN so that the line breaks between them. The first
/// sample after a phase is taken along: no gaps where the colour changes.
Curve phase_curve(const RunData& data, const WallCycles& cycles, WallPhase phase, double factor,
                  const char* title, Ink ink) {
  Curve curve;
  curve.title = title;
  curve.ink = ink;
  curve.width = 2.2;
  const size_t first = cycles.periods[cycles.loop_first].first,
               last = cycles.periods[cycles.loop_last - 1].last;
  for (size_t k = first; k < last; ++k) {
    const bool is_in = cycles.phase[k] == phase, was_in = k > first && cycles.phase[k - 1] == phase;
    curve.x.push_back(is_in || was_in ? 1e3 * data.steps[k].wall_x : not_known);
    curve.y.push_back(is_in || was_in ? factor * cycles.force[k] : not_known);
  }
  return curve;
}

/// The fits, drawn along every stroke of the loop from its own jamming position.
Curve fit_curve(const RunSummary& summary, double factor) {
  Curve curve;
  curve.title = "fits";
  curve.ink = Ink::black;
  curve.dashed = true;
  curve.width = 1.3;
  const auto add = [&](double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
  };
  constexpr int parts = 32;
  for (size_t p = summary.wall.loop_first; p < summary.wall.loop_last; ++p) {
    const WallPeriod& period = summary.wall.periods[p];
    const double out = period.x_peak - period.x_before, in = period.x_peak - period.x_after;
    for (int k = 0; k <= parts; ++k)
      add(1e3 * (period.x_before + out * k / parts),
          factor * summary.loop.active.at(out * k / parts));
    add(not_known, not_known);
    for (int k = 0; k <= parts; ++k)
      add(1e3 * (period.x_after + in * k / parts),
          factor * summary.loop.passive.at(in * k / parts));
    add(not_known, not_known);
  }
  return curve;
}

double largest(const std::vector<double>& values) { return statistics(values).max; }

page::Text fit_caption(const LoopFits& loop) {
  return page::words("run.fig04.fits",
                     {{"amplitude", page::quantity(loop.active.amplitude, "N")},
                      {"length", page::quantity(1e3 / loop.active.rate, "mm")},
                      {"active", page::number(loop.active.r2)},
                      {"line", page::number(loop.active_line.r2)},
                      {"offset", page::quantity(loop.passive.offset, "N")},
                      {"slope", page::quantity(-1e-3 * loop.passive.slope, "N/mm")},
                      {"passive", page::number(loop.passive.r2)}});
}

}  // namespace

page::Picture figure_3(const RunData& data, const RunSummary& summary) {
  const ForceUnit unit = force_unit(summary.facts.f_max);
  const auto time = record_column(data.steps, &StepRecord::time);
  Panel above, below;
  above.x_label = below.x_label = time_axis;
  above.y_label = "{/:Italic x}  (mm)";
  below.y_label = std::string("{/:Italic f}  (") + unit.name + ")";
  above.curves = {
      line_of(time, record_column(data.steps, &StepRecord::wall_x, 1e3), "", Ink::blue, 2.0)};
  below.curves = {line_of(time, record_column(data.steps, &StepRecord::load, unit.factor), "",
                          Ink::vermilion, 2.0)};
  above.x_min = below.x_min = 0.0;
  above.x_max = below.x_max = data.steps.back().time;
  above.lines = {{0.0, "", false, Ink::light}};
  Figure figure;
  figure.name = "fig03";
  figure.title = "Displacement of the driven wall and driving force against time";
  figure.height = 560;
  figure.panels = {above, below};
  if (!*summary.facts.has_packing) return {figure, {page::words("run.fig03.wall_alone")}};
  page::Text caption = page::words("run.fig03.paper");
  if (std::isfinite(summary.contraction.size))
    caption += page::words("run.fig03.contraction",
                           {{"size", page::quantity(1e3 * summary.contraction.size, "mm")},
                            {"time", page::quantity(summary.contraction.time90, "s")},
                            {"rise", page::quantity(1e3 * summary.rise.mean, "mm")},
                            {"net", page::quantity(-1e3 * summary.net.mean, "mm")}});
  return {figure, {caption + page::words("run.fig03.look")}};
}

page::Picture figure_4(const RunData& data, const RunSummary& summary) {
  const WallCycles& cycles = summary.wall;
  const ForceUnit unit = force_unit(summary.facts.f_max);
  const size_t first = cycles.periods[cycles.loop_first].first,
               last = cycles.periods[cycles.loop_last - 1].last;
  Curve raw;
  raw.title = "each step";
  raw.ink = Ink::light;
  raw.width = 0.7;
  for (size_t k = first; k < last; ++k) {
    raw.x.push_back(1e3 * data.steps[k].wall_x);
    raw.y.push_back(unit.factor * data.steps[k].wall_force);
  }
  Panel panel;
  panel.x_label = "{/:Italic x}  (mm)";
  panel.y_label = std::string("{/:Italic f}_g  (") + unit.name + ")";
  panel.curves = {
      raw, phase_curve(data, cycles, WallPhase::jammed, unit.factor, "jammed", Ink::green),
      phase_curve(data, cycles, WallPhase::active, unit.factor, "active", Ink::blue),
      phase_curve(data, cycles, WallPhase::passive, unit.factor, "passive", Ink::vermilion)};
  if (std::isfinite(summary.loop.active.r2) && std::isfinite(summary.loop.passive.r2))
    panel.curves.push_back(fit_curve(summary, unit.factor));
  // spikes of single steps may be many times the smoothed force: they are cut off, and the caption
  // says so
  double top = unit.factor * summary.facts.f_max;
  for (size_t c = 1; c < 4; ++c)
    if (const double peak = largest(panel.curves[c].y); peak > top) top = peak;
  panel.y_min = 0.0;
  panel.y_max = 1.1 * top;
  Figure figure;
  figure.name = "fig04";
  figure.title = "Force of the grains on the driven wall against its displacement";
  figure.height = 580;
  figure.panels = {panel};
  page::Text caption = page::words(
      "run.fig04.paper",
      {{"periods", page::exact(static_cast<double>(cycles.loop_last - cycles.loop_first))},
       {"smoothing", page::exact_quantity(1e3 * cycles.smoothing, "ms")}});
  if (std::isfinite(summary.loop.active.r2) && std::isfinite(summary.loop.passive.r2))
    caption += fit_caption(summary.loop);
  if (std::abs(summary.net.mean) > 0.05 * summary.rise.mean)
    caption += page::words("run.fig04.side_by_side");
  return {figure, {caption}};
}

page::Picture figure_12(const RunData& data, const RunSummary& summary) {
  const Compaction& compaction = summary.compaction;
  auto change = record_column(data.steps, &StepRecord::solid_fraction);
  for (double& value : change) value -= compaction.initial;
  Panel panel;
  panel.x_label = time_axis;
  panel.y_label = "Δ{/:Italic ρ}";
  panel.curves = {line_of(record_column(data.steps, &StepRecord::time), change, "Δ{/:Italic ρ}",
                          Ink::blue, 1.8)};
  panel.x_min = 0.0;
  panel.x_max = data.steps.back().time;
  panel.lines = {{paper_window.begin, "0.2 s", true, Ink::grey}};
  const std::vector<WallPeriod>& periods = summary.wall.periods;
  const bool has_gain = std::isfinite(compaction.gain) && periods.front().first > 0;
  if (has_gain) {
    // from the first period's begin to the last one's end: its slope is the mean gain
    Curve line;
    line.title = "gain per period " + plot_label(page::number(compaction.gain));
    line.ink = Ink::vermilion;
    line.dashed = true;
    line.width = 1.8;
    line.x = {periods.front().begin, periods.back().end};
    line.y = {change[periods.front().first - 1], change[periods.back().last - 1]};
    panel.curves.push_back(line);
  }
  Figure figure;
  figure.name = "fig12";
  figure.title = "Change of the solid fraction against time";
  figure.height = 440;
  figure.panels = {panel};
  page::Text caption =
      page::words("run.fig12.paper", {{"initial", page::number(compaction.initial, 4)},
                                      {"reference", page::number(compaction.reference, 4)}});
  if (has_gain)
    caption += page::words("run.fig12.trend", {{"slope", page::number(compaction.gain)},
                                               {"gain", page::number(compaction.relative_gain)}});
  return {figure, {caption + page::words("run.fig12.look")}};
}

page::Picture jammed_figure(const RunData& data, const RunSummary& summary) {
  const WallCycles& cycles = summary.wall;
  const auto time = record_column(data.steps, &StepRecord::time);
  std::vector<double> miss, speed, jammed_miss, jammed_speed;
  for (size_t k = 0; k < data.steps.size(); ++k) {
    const bool is_jammed = cycles.phase[k] == WallPhase::jammed;
    miss.push_back(std::abs(data.steps[k].wall_force - data.steps[k].load) / summary.facts.f_max);
    speed.push_back(1e3 * std::abs(data.steps[k].wall_v));
    jammed_miss.push_back(is_jammed ? miss[k] : not_known);
    jammed_speed.push_back(is_jammed ? speed[k] : not_known);
  }
  // single steps cross zero: the axis ends where one in a hundred is below
  const auto low = [](const std::vector<double>& values) {
    std::vector<double> positive;
    for (double value : values)
      if (value > 0.0) positive.push_back(value);
    return std::pow(10.0, std::floor(std::log10(quantile(positive, 0.01))));
  };
  Panel above, below;
  above.x_label = below.x_label = time_axis;
  above.log_y = below.log_y = true;
  above.y_label = "|{/:Italic f}_g\u00a0−\u00a0{/:Italic f}\u2009| / {/:Italic f}_{max}";
  below.y_label = "|{/:Italic v}|  (mm/s)";
  above.curves = {line_of(time, miss, "all steps", Ink::light, 0.8),
                  line_of(time, jammed_miss, "jammed", Ink::green, 1.2)};
  below.curves = {line_of(time, speed, "all steps", Ink::light, 0.8),
                  line_of(time, jammed_speed, "jammed", Ink::green, 1.2)};
  above.lines = {{target::jammed_force, "10^{−3}", false, Ink::grey}};
  if (const double least = low(miss); std::isfinite(least)) above.y_min = std::min(least, 1e-4);
  if (const double least = low(speed); std::isfinite(least)) below.y_min = least;
  above.x_min = below.x_min = 0.0;
  above.x_max = below.x_max = data.steps.back().time;
  Figure figure;
  figure.name = "jammed";
  figure.title = "Imbalance of forces and velocity of the wall, jammed state marked";
  figure.height = 560;
  figure.panels = {above, below};
  page::Text caption = page::words("run.jammed.paper");
  const JammedState& jammed = summary.jammed;
  if (jammed.samples > 0)
    caption += page::words("run.jammed.found",
                           {{"mean", page::number(jammed.force_mean)},
                            {"p95", page::number(jammed.force_p95)},
                            {"speed", page::quantity(1e3 * jammed.speed_mean, "mm/s")}});
  return {figure, {caption + page::words("run.jammed.look")}};
}

std::vector<page::Picture> paper_figures(const RunData& data, const RunSummary& summary) {
  std::vector<page::Picture> figures;
  const bool has_loop = summary.wall.loop_first < summary.wall.loop_last;
  const bool has_packing = *summary.facts.has_packing;
  if (*summary.facts.has_wall) figures.push_back(figure_3(data, summary));
  if (has_loop && has_packing) figures.push_back(figure_4(data, summary));
  if (has_packing) figures.push_back(figure_12(data, summary));
  return figures;
}

}  // namespace ballast
