// Figures 3, 4 and 12 of the paper, and what the jammed state tells.

#include <algorithm>
#include <cmath>

#include "experiments/run_page/figures.hpp"
#include "experiments/step/step_record.hpp"
#include "platform/text.hpp"

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

Html fit_caption(const RunSummary& summary) {
  const LoopFits& loop = summary.loop;
  Html caption{
      " Dashed: least squares over these periods together, in the middle 80&#8239;% of each "
      "stroke, with &xi; the displacement from "
      "the stroke’s own jamming position. Active: <i>f</i><sub>g</sub> = "};
  caption += quantity(loop.active.amplitude, "N") + Html{" · exp(&xi;/"} +
             quantity(1e3 / loop.active.rate, "mm") + Html{"), <i>R</i>² = "} +
             number(loop.active.r2) + Html{" (a straight line: "} + number(loop.active_line.r2) +
             Html{"). Passive: <i>f</i><sub>g</sub> = "} + quantity(loop.passive.offset, "N") +
             Html{" − "} + quantity(-1e-3 * loop.passive.slope, "N/mm") +
             Html{" · &xi;, <i>R</i>² = "} + number(loop.passive.r2) + Html{"."};
  return caption;
}

}  // namespace

ReportFigure figure_3(const RunData& data, const RunSummary& summary) {
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
  if (!*summary.facts.has_packing)
    return {figure,
            {"<b>The driven wall.</b> Outward displacement <i>x</i> (above) under the compressive "
             "load <i>f</i> (below)."}};
  Html caption{
      "<b>Paper, Fig. 3.</b> Outward displacement <i>x</i> of the driven wall (above) under the "
      "compressive load <i>f</i> (below). "
      "The paper shows a fast first contraction, over within about 0.2&#8239;s, and then a "
      "periodic motion on which a slow "
      "contraction rides. "};
  if (std::isfinite(summary.contraction.size))
    caption += Html{"Here the wall first goes in by "} +
               quantity(1e3 * summary.contraction.size, "mm") + Html{", 90&#8239;% of it by "} +
               quantity(summary.contraction.time90, "s") + Html{"; then it moves out by "} +
               quantity(1e3 * summary.rise.mean, "mm") + Html{" in a period and loses "} +
               quantity(-1e3 * summary.net.mean, "mm") + Html{" per period. "};
  caption +=
      {"<span class=\"look\">Look for flat tops of <i>f</i> where <i>x</i> stands still (jammed), "
       "and for extension only while "
       "<i>f</i> is small.</span>"};
  return {figure, caption};
}

ReportFigure figure_4(const RunData& data, const RunSummary& summary) {
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
  const size_t periods = cycles.loop_last - cycles.loop_first;
  Html caption{
      "<b>Paper, Fig. 4.</b> Force <i>f</i><sub>g</sub> of the grains on the wall against its "
      "displacement, over the last "};
  caption += exact(static_cast<double>(periods)) +
             Html{
                 " whole periods after the first 0.2&#8239;s. A step’s <i>f</i><sub>g</sub> is its "
                 "impulses divided by <i>h</i> and noisy (grey, cut off above the axis); the "
                 "coloured line is its low-pass, a Hann window of "} +
             exact(1e3 * cycles.smoothing) + Html{"&#8239;ms"} +
             Html{
                 ". Colours: the wall moves out (active), in (passive), or stands still around the "
                 "load’s maximum (jammed). "} +
             Html{
                 "The paper shows a slightly exponential growth in the active phase, a faster and "
                 "almost linear one in the passive, and the "
                 "vertical jammed branch on which <i>f</i><sub>g</sub> = <i>f</i>."};
  if (std::isfinite(summary.loop.active.r2) && std::isfinite(summary.loop.passive.r2))
    caption += fit_caption(summary);
  const double net = std::abs(summary.net.mean), rise = summary.rise.mean;
  if (net > 0.05 * rise)
    caption +=
        Html{" The loops lie side by side because the packing contracts from period to period."};
  return {figure, caption};
}

ReportFigure figure_12(const RunData& data, const RunSummary& summary) {
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
    line.title = "gain per period " + printed("%.3g", compaction.gain);
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
  Html caption{
      "<b>Paper, Fig. 12.</b> Solid fraction in the control volume minus its value before the "
      "drive, "};
  caption += number(compaction.initial, 4) + Html{" (paper: 0.50). At 0.2&#8239;s it is "} +
             number(compaction.reference, 4) +
             Html{" (paper: &rho;<sub>0</sub> ≈ 0.52, a first compaction of 2&#8239;%)."};
  if (has_gain)
    caption += Html{" Dashed: the mean gain over the periods after the transient, "} +
               number(compaction.gain) + Html{" per period, that is "} +
               number(compaction.relative_gain) +
               Html{" &rho;<sub>0</sub> (paper, Eq. 5: about 0.0025 below 10&#8239;Hz)."};
  caption += {" <span class=\"look\">Look for oscillations around a straight slow rise.</span>"};
  return {figure, caption};
}

ReportFigure jammed_figure(const RunData& data, const RunSummary& summary) {
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
  Html caption{
      "<b>The jammed state.</b> The paper has <i>f</i><sub>g</sub> = <i>f</i> there. Jammed: the "
      "unbroken stretch around a load "
      "maximum in which |<i>v</i>| stays below 2&#8239;% of its largest value, a bound so loose "
      "that it doesn’t decide what is measured. "};
  const JammedState& jammed = summary.jammed;
  if (jammed.samples > 0)
    caption +=
        Html{
            "While <i>f</i> is above its mean, |<i>f</i><sub>g</sub> − "
            "<i>f</i>|/<i>f</i><sub>max</sub> is "} +
        number(jammed.force_mean) + Html{" on average, below "} + number(jammed.force_p95) +
        Html{" in 95&#8239;% of the steps, and the wall moves at "} +
        quantity(1e3 * jammed.speed_mean, "mm/s") + Html{". "};
  caption +=
      {"<span class=\"look\">The residual velocity is the more sensitive of the two: a loose "
       "solver makes the packing elastic, and it "
       "shows here first.</span>"};
  return {figure, caption};
}

std::vector<ReportFigure> paper_figures(const RunData& data, const RunSummary& summary) {
  std::vector<ReportFigure> figures;
  const bool has_loop = summary.wall.loop_first < summary.wall.loop_last;
  const bool has_packing = *summary.facts.has_packing;
  if (*summary.facts.has_wall) figures.push_back(figure_3(data, summary));
  if (has_loop && has_packing) figures.push_back(figure_4(data, summary));
  if (has_packing) figures.push_back(figure_12(data, summary));
  return figures;
}

}  // namespace ballast
