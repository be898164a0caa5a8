// Figures 3, 4 and 12 of the paper, and what the jammed state tells.

#include <algorithm>
#include <cmath>

#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

/// f_g [unit] against x [mm] over the periods of the loop, of the samples that `is_drawn` takes;
/// the others are NaN, so that the line breaks between them.
template <class IsDrawn>
Curve loop_curve(const RunData& data, const WallCycles& cycles, const std::vector<double>& force,
                 double factor, const IsDrawn& is_drawn) {
  Curve curve;
  const size_t first = cycles.periods[cycles.loop_first].first,
               last = cycles.periods[cycles.loop_last - 1].last;
  for (size_t k = first; k < last; ++k) {
    // the first sample after a phase is taken along: no gaps where the colour changes
    const bool is_in = is_drawn(k) || (k > first && is_drawn(k - 1));
    curve.x.push_back(is_in ? 1e3 * data.steps[k].wall_x : not_known);
    curve.y.push_back(is_in ? factor * force[k] : not_known);
  }
  return curve;
}

/// The fits, drawn along every stroke of the loop from its own jamming position.
Curve fit_curve(const RunSummary& summary, double factor) {
  Curve curve{.title = "fits", .ink = Ink::black, .width = 1.3, .dashed = true};
  constexpr int parts = 32;
  const auto add = [&](double jam, double stroke, const auto& law) {
    for (int k = 0; k <= parts; ++k) {
      curve.x.push_back(1e3 * (jam + stroke * k / parts));
      curve.y.push_back(factor * law.at(stroke * k / parts));
    }
    curve.x.push_back(not_known);
    curve.y.push_back(not_known);
  };
  for (size_t p = summary.wall.loop_first; p < summary.wall.loop_last; ++p) {
    const WallPeriod& period = summary.wall.periods[p];
    add(period.x_before, period.x_peak - period.x_before, summary.loop.active);
    add(period.x_after, period.x_peak - period.x_after, summary.loop.passive);
  }
  return curve;
}

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

/// One quantity of the wall at all steps, and at the jammed ones, on a logarithmic axis.
Panel jammed_panel(const RunData& data, const WallCycles& cycles, const std::vector<double>& all,
                   const char* y_label, double highest_end) {
  std::vector<double> jammed = all, positive = all;
  for (size_t k = 0; k < all.size(); ++k)
    if (cycles.phase[k] != WallPhase::jammed) jammed[k] = not_known;
  const auto time = record_column(data.steps, &StepRecord::time);
  Panel panel = time_panel(data, y_label, true);
  panel.curves = {line_of(time, all, "all steps", Ink::light, 0.8),
                  line_of(time, jammed, "jammed", Ink::green, 1.2)};
  // single steps cross zero: the axis ends where one in a hundred is below
  std::erase_if(positive, [](double value) { return !(value > 0.0); });
  const double end = std::pow(10.0, std::floor(std::log10(quantile(positive, 0.01))));
  if (std::isfinite(end)) panel.y_min = std::min(end, highest_end);
  return panel;
}

}  // namespace

page::Picture figure_3(const RunData& data, const RunSummary& summary) {
  const ForceUnit unit = force_unit(summary.facts.f_max);
  Panel above = time_panel(data, "{/:Italic x}  (mm)"),
        below = time_panel(data, std::string("{/:Italic f}  (") + unit.name + ")");
  above.curves = {column_line(data, &StepRecord::wall_x, 1e3, "", Ink::blue, 2.0)};
  below.curves = {column_line(data, &StepRecord::load, unit.factor, "", Ink::vermilion, 2.0)};
  above.lines = {{0.0, "", false, Ink::light}};
  page::Text caption =
      page::words(*summary.facts.has_packing ? "run.fig03.paper" : "run.fig03.wall_alone");
  if (*summary.facts.has_packing) {
    if (std::isfinite(summary.contraction.size))
      caption += page::words("run.fig03.contraction",
                             {{"size", page::quantity(1e3 * summary.contraction.size, "mm")},
                              {"time", page::quantity(summary.contraction.time90, "s")}});
    if (std::isfinite(summary.rise.mean))
      caption += page::words("run.fig03.periods",
                             {{"rise", page::quantity(1e3 * summary.rise.mean, "mm")},
                              {"net", page::quantity(-1e3 * summary.net.mean, "mm")}});
    caption += page::words("run.fig03.look");
  }
  return run_picture("fig03", 560, {above, below}, caption);
}

page::Picture figure_4(const RunData& data, const RunSummary& summary) {
  const WallCycles& cycles = summary.wall;
  const ForceUnit unit = force_unit(summary.facts.f_max);
  const bool has_fits =
      std::isfinite(summary.loop.active.r2) && std::isfinite(summary.loop.passive.r2);
  Panel panel{.x_label = "{/:Italic x}  (mm)",
              .y_label = std::string("{/:Italic f}_g  (") + unit.name + ")",
              .y_min = 0.0};
  // each step grey below, the smoothed force of each phase in its colour above
  const auto add = [&](const std::vector<double>& force, const char* title, Ink ink, double width,
                       const auto& is_drawn) {
    Curve curve = loop_curve(data, cycles, force, unit.factor, is_drawn);
    curve.title = title;
    curve.ink = ink;
    curve.width = width;
    panel.curves.push_back(curve);
  };
  add(record_column(data.steps, &StepRecord::wall_force), "each step", Ink::light, 0.7,
      [](size_t) { return true; });
  // spikes of single steps may be many times the smoothed force: they are cut off, and the caption
  // says so
  double top = unit.factor * summary.facts.f_max;
  for (const auto& [phase, title, ink] :
       {std::tuple{WallPhase::jammed, "jammed", Ink::green},
        std::tuple{WallPhase::active, "active", Ink::blue},
        std::tuple{WallPhase::passive, "passive", Ink::vermilion}}) {
    add(cycles.force, title, ink, 2.2,
        [&, wanted = phase](size_t k) { return cycles.phase[k] == wanted; });
    if (const double peak = statistics(panel.curves.back().y).max; peak > top) top = peak;
  }
  panel.y_max = 1.1 * top;
  if (has_fits) panel.curves.push_back(fit_curve(summary, unit.factor));
  page::Text caption = page::words(
      "run.fig04.paper",
      {{"periods", page::exact(static_cast<double>(cycles.loop_last - cycles.loop_first))},
       {"smoothing", page::exact_quantity(1e3 * cycles.smoothing, "ms")}});
  if (has_fits) caption += fit_caption(summary.loop);
  if (std::abs(summary.net.mean) > 0.05 * summary.rise.mean)
    caption += page::words("run.fig04.side_by_side");
  return run_picture("fig04", 580, {panel}, caption);
}

void draw_solid_fraction(const RunData& data, double initial, const std::string& title, Ink ink,
                         double width, Panel& panel) {
  auto change = record_column(data.steps, &StepRecord::solid_fraction);
  for (double& value : change) value -= initial;
  std::vector<Curve> curves = std::move(panel.curves);
  panel = time_panel(data, "Δ{/:Italic ρ}");
  panel.lines = {{paper_window.begin, "0.2 s", true, Ink::grey}};
  curves.push_back(
      line_of(record_column(data.steps, &StepRecord::time), change, title, ink, width));
  panel.curves = std::move(curves);
}

page::Picture figure_12(const RunData& data, const RunSummary& summary) {
  const Compaction& compaction = summary.compaction;
  Panel panel;
  draw_solid_fraction(data, compaction.initial, "Δ{/:Italic ρ}", Ink::blue, 1.8, panel);
  page::Text caption =
      page::words("run.fig12.paper", {{"initial", page::number(compaction.initial, 4)}});
  if (std::isfinite(compaction.reference))
    caption +=
        page::words("run.fig12.reference", {{"reference", page::number(compaction.reference, 4)}});
  const std::vector<WallPeriod>& periods = summary.wall.periods;
  if (std::isfinite(compaction.gain) && periods.front().first > 0) {
    // from the first period's begin to the last one's end: its slope is the mean gain
    const auto change_after = [&](size_t samples) {
      return data.steps[samples - 1].solid_fraction - compaction.initial;
    };
    panel.curves.push_back(
        {.x = {periods.front().begin, periods.back().end},
         .y = {change_after(periods.front().first), change_after(periods.back().last)},
         .title = "gain per period " + plot_label(page::number(compaction.gain)),
         .ink = Ink::vermilion,
         .width = 1.8,
         .dashed = true});
    caption += page::words("run.fig12.trend", {{"slope", page::number(compaction.gain)},
                                               {"gain", page::number(compaction.relative_gain)}});
  }
  return run_picture("fig12", 440, {panel}, caption + page::words("run.fig12.look"));
}

page::Picture jammed_figure(const RunData& data, const RunSummary& summary) {
  std::vector<double> miss, speed;
  for (const StepRecord& step : data.steps) {
    miss.push_back(std::abs(step.wall_force - step.load) / summary.facts.f_max);
    speed.push_back(1e3 * std::abs(step.wall_v));
  }
  Panel above =
      jammed_panel(data, summary.wall, miss,
                   "|{/:Italic f}_g\u00a0−\u00a0{/:Italic f}\u2009| / {/:Italic f}_{max}", 1e-4);
  above.lines = {{target::jammed_force, "10^{−3}", false, Ink::grey}};
  const Panel below = jammed_panel(data, summary.wall, speed, "|{/:Italic v}|  (mm/s)", 1e300);
  page::Text caption = page::words("run.jammed.paper");
  const JammedState& jammed = summary.jammed;
  if (jammed.samples > 0)
    caption += page::words("run.jammed.found",
                           {{"mean", page::number(jammed.force_mean)},
                            {"p95", page::number(jammed.force_p95)},
                            {"speed", page::quantity(1e3 * jammed.speed_mean, "mm/s")}});
  return run_picture("jammed", 560, {above, below}, caption + page::words("run.jammed.look"));
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
