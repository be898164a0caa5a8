#include "experiments/run_page/figures.hpp"

#include <algorithm>
#include <cmath>

#include "platform/text.hpp"

namespace ballast {
namespace {

/// A figure of this page: its title is words(run.<name>.title).
page::Picture run_picture(const std::string& name, int height, std::vector<Panel> panels,
                          page::Text caption) {
  return {.plot = {.name = name,
                   .title = plain_words(page::words("run." + name + ".title")),
                   .height = height,
                   .panels = std::move(panels)},
          .caption = {std::move(caption)}};
}

/// A panel over the run's time; the label in the notation of page::marked().
Panel time_panel(const RunData& data, const std::string& label, bool log_y = false) {
  return {.x_label = page::marked("*t*  (s)"),
          .y_label = page::marked(label),
          .log_y = log_y,
          .x_min = 0.0,
          .x_max = data.steps.back().time};
}

/// `factor` times a column of the record against time.
Curve column_line(const RunData& data, double StepRecord::*value, double factor,
                  const page::Text& title, Ink ink, double width) {
  return line_of(record_column(data.steps, &StepRecord::time),
                 record_column(data.steps, value, factor), title, ink, width);
}

/// The fits, drawn along every stroke of the loop from its own jamming position.
Curve fit_curve(const RunSummary& summary, double factor) {
  Curve curve{.title = "fits", .ink = Ink::black, .width = 1.3, .dash = 1};
  constexpr int parts = 32;
  const auto add = [&](double jam, double stroke, const auto& law) {
    for (int k = 0; k <= parts; ++k)
      curve.add(1e3 * (jam + stroke * k / parts), factor * law.at(stroke * k / parts));
    curve.add(not_known, not_known);
  };
  for (const WallPeriod& period : summary.wall.loop()) {
    add(period.x_before, period.x_peak - period.x_before, summary.law.active);
    add(period.x_after, period.x_peak - period.x_after, summary.law.passive);
  }
  return curve;
}

/// One quantity of the wall at all steps, and at the jammed ones, on a logarithmic axis.
Panel jammed_panel(const RunData& data, const WallCycles& cycles, const std::vector<double>& all,
                   const char* label, double highest_end) {
  std::vector<double> jammed = all, positive = all;
  for (size_t k = 0; k < all.size(); ++k)
    if (cycles.phase[k] != WallPhase::jammed) jammed[k] = not_known;
  const auto time = record_column(data.steps, &StepRecord::time);
  Panel panel = time_panel(data, label, true);
  panel.curves = {line_of(time, all, "all steps", Ink::light, 0.8),
                  line_of(time, jammed, "jammed", Ink::green, 1.2)};
  // single steps cross zero: the axis ends at the decade below which one value in a hundred lies
  std::erase_if(positive, [](double value) { return !(value > 0.0); });
  const double end = std::pow(10.0, std::floor(std::log10(quantile(positive, 0.01))));
  if (std::isfinite(end)) panel.y_min = std::min(end, highest_end);
  return panel;
}

page::Picture figure_12(const RunData& data, const RunSummary& summary) {
  const Compaction& compaction = summary.compaction;
  Panel panel = solid_fraction_panel(data);
  panel.curves = {solid_fraction_line(data, page::marked("Δ*ρ*"), Ink::blue, 1.8)};
  const double initial = summary.facts.solid_fraction_initial;
  page::Text caption = page::words("run.fig12.paper", {{"initial", page::number(initial, 4)}});
  if (std::isfinite(compaction.reference))
    caption +=
        page::words("run.fig12.reference", {{"reference", page::number(compaction.reference, 4)}});
  if (compaction.has_wall_inside) caption += page::words("run.fig12.inside");
  const std::vector<WallPeriod>& periods = summary.wall.periods;
  if (std::isfinite(compaction.gain) && periods.front().first > 0) {
    // a line from the first period's begin to the last one's end: its slope is the mean gain
    const auto change_after = [&](size_t samples) {
      return data.steps[samples - 1].solid_fraction - initial;
    };
    panel.curves.push_back(
        {.x = {periods.front().begin, periods.back().end},
         .y = {change_after(periods.front().first), change_after(periods.back().last)},
         .title = "gain per period " + page::number(compaction.gain),
         .ink = Ink::vermilion,
         .width = 1.8,
         .dash = 1});
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
      jammed_panel(data, summary.wall, miss, "|*f*~g~\u00a0−\u00a0*f*\u2009| / *f*~max~", 1e-4);
  above.lines = {{target::jammed_force, page::marked("10^−3^")}};
  const Panel below = jammed_panel(data, summary.wall, speed, "|*v*|  (mm/s)", 1e300);
  page::Text caption = page::words("run.jammed.paper");
  const JammedState& jammed = summary.jammed;
  if (jammed.samples > 0)
    caption += page::words("run.jammed.found",
                           {{"mean", page::number(jammed.force_mean)},
                            {"p95", page::number(jammed.force_p95)},
                            {"speed", page::quantity(1e3 * jammed.speed_mean, "mm/s")}});
  return run_picture("jammed", 560, {above, below}, caption + page::words("run.jammed.look"));
}

page::Picture error_figure(const RunData& data, const RunSummary& summary) {
  const double scale = summary.facts.velocity_scale;
  Panel panel = time_panel(data, printed("error  (%s)", error_unit(summary)), true);
  panel.curves = {
      column_line(data, &StepRecord::error_max, 1.0 / scale, "worst contact", Ink::light, 0.8),
      column_line(data, &StepRecord::error_rms, 1.0 / scale, "rms over contacts", Ink::blue, 1.4)};
  const double tolerance = summary.facts.tolerance;
  if (std::isfinite(tolerance)) panel.lines = {{tolerance, printed("%g: tolerance", tolerance)}};
  const bool has_gravity = std::string_view(error_unit(summary)) == "g h";
  page::Text caption = page::words(
      "run.error", {{"unit", page::words(has_gravity ? "run.error.gravity" : "run.error.none",
                                         {{"scale", page::quantity(scale, "m/s")}})},
                    {"mean", page::number(summary.error_mean_relative)},
                    {"max", page::number(summary.error_max_relative)}});
  if (summary.facts.has_packing) caption += page::words("run.error.box");
  return run_picture("error", 420, {panel}, caption);
}

page::Picture penetration_figure(const RunData& data, const RunSummary& summary) {
  Panel panel = time_panel(data, "overlap  (µm)", true);
  panel.curves = {
      column_line(data, &StepRecord::penetration_max, 1e6, "deepest", Ink::vermilion, 1.4),
      column_line(data, &StepRecord::penetration_mean, 1e6, "mean over active contact points",
                  Ink::blue, 1.4)};
  if (summary.facts.has_packing)
    panel.lines = {{1e6 * target::penetration_max, "250 µm: bound on the deepest"},
                   {1e6 * target::penetration_mean, "5 µm: bound on the mean"}};
  // the axis ends at the decade below nearly all means
  std::vector<double> means = panel.curves[1].y;
  std::erase_if(means, [](double value) { return !(value > 0.0); });
  if (const double least = quantile(means, 0.02); std::isfinite(least))
    panel.y_min = std::pow(10.0, std::floor(std::log10(std::min(least, 1.0))));
  page::Text caption = page::words(
      "run.penetration", {{"deepest", page::quantity(1e6 * summary.penetration_max, "µm")},
                          {"time", page::quantity(summary.penetration_max_time, "s")},
                          {"mean", page::quantity(1e6 * summary.penetration_mean, "µm")}});
  if (summary.facts.has_packing) caption += page::words("run.penetration.box");
  return run_picture("penetration", 420, {panel}, caption);
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

page::Picture energy_figure(const RunData& data, const RunSummary& summary) {
  const auto time = record_column(data.steps, &StepRecord::time);
  Panel above = time_panel(data, "cumulative energy  (J)"),
        below = time_panel(data, "energy  (J)", true);
  const auto add_sum = [&](double StepRecord::*value, const char* title, Ink ink) {
    auto sums = record_column(data.steps, value);
    if (std::ranges::all_of(sums, [](double v) { return v == 0.0 || std::isnan(v); })) return;
    for (size_t k = 1; k < sums.size(); ++k) sums[k] += sums[k - 1];
    above.curves.push_back(line_of(time, sums, title, ink, 1.8));
  };
  add_sum(&StepRecord::work_load, "work of the load", Ink::blue);
  add_sum(&StepRecord::work_gravity, "of gravity", Ink::green);
  add_sum(&StepRecord::work_prescribed, "of walls and forces", Ink::orange);
  add_sum(&StepRecord::dissipated, "dissipated", Ink::vermilion);
  // absolute value of the change of kinetic energy − works + dissipation since the start
  std::vector<double> residual(data.steps.size(), data.steps.front().energy_residual);
  for (size_t k = 1; k < residual.size(); ++k) {
    const StepRecord& step = data.steps[k];
    residual[k] = residual[k - 1] + step.kinetic_energy - data.steps[k - 1].kinetic_energy -
                  step.work_load - step.work_gravity - step.work_prescribed + step.dissipated;
  }
  for (double& value : residual) value = std::abs(value);
  below.curves = {
      column_line(data, &StepRecord::kinetic_energy, 1.0, "kinetic energy", Ink::black, 1.4),
      line_of(time, residual, "|residual of the balance|", Ink::purple, 1.4)};
  std::vector<Panel> panels{below};
  if (!above.curves.empty()) panels.insert(panels.begin(), above);
  return run_picture(
      "energy", 580, panels,
      page::words("run.energy", {{"residual", page::quantity(summary.energy.residual, "J")},
                                 {"relative", page::number(summary.energy.relative)}}));
}

}  // namespace

Curve line_of(std::vector<double> x, std::vector<double> y, const page::Text& title, Ink ink,
              double width) {
  thin_out(x, y, 3000);
  return {.x = std::move(x), .y = std::move(y), .title = title, .ink = ink, .width = width};
}

ForceUnit force_unit(double f_max) {
  return f_max >= 1000.0 ? ForceUnit{"kN", 1e-3} : ForceUnit{"N", 1.0};
}

page::Picture figure_3(const RunData& data, const RunSummary& summary) {
  const ForceUnit unit = force_unit(summary.facts.f_max);
  Panel above = time_panel(data, "*x*  (mm)"),
        below = time_panel(data, std::string("*f*  (") + unit.name + ")");
  above.curves = {column_line(data, &StepRecord::wall_x, 1e3, "", Ink::blue, 2.0)};
  below.curves = {column_line(data, &StepRecord::load, unit.factor, "", Ink::vermilion, 2.0)};
  above.lines = {{0.0, "", false, Ink::light}};
  page::Text caption =
      page::words(summary.facts.has_packing ? "run.fig03.paper" : "run.fig03.wall_alone");
  if (summary.facts.has_packing) {
    if (summary.contraction.size > 0.0)
      caption += page::words("run.fig03.contraction",
                             {{"size", page::quantity(1e3 * summary.contraction.size, "mm")},
                              {"time", page::quantity(summary.contraction.time90, "s")}});
    if (std::isfinite(summary.rise.mean))
      caption += page::words("run.fig03.periods",
                             {{"rise", page::quantity(1e3 * summary.rise.mean, "mm")},
                              {"way", summary.net.mean > 0.0 ? "gains" : "loses"},
                              {"net", page::quantity(1e3 * std::abs(summary.net.mean), "mm")}});
    caption += page::words("run.fig03.look");
  }
  return run_picture("fig03", 560, {above, below}, caption);
}

page::Picture figure_4(const RunData& data, const RunSummary& summary) {
  const WallCycles& cycles = summary.wall;
  const ForceUnit unit = force_unit(summary.facts.f_max);
  const bool has_fits =
      std::isfinite(summary.law.active.r2) && std::isfinite(summary.law.passive.r2);
  Panel panel{.x_label = page::marked("*x*  (mm)"),
              .y_label = page::marked("*f*~g~  (") + unit.name + ")",
              .y_min = 0.0};
  // The force of each step is grey, the smoothed force of each phase above it has a colour. `add`
  // draws the samples of the loop's periods that `is_drawn` takes; the line breaks between them.
  const size_t first = cycles.loop().front().first, last = cycles.loop().back().last;
  const auto add = [&](const std::vector<double>& force, const char* title, Ink ink, double width,
                       const auto& is_drawn) {
    Curve& curve = panel.curves.emplace_back(Curve{.title = title, .ink = ink, .width = width});
    for (size_t k = first; k < last; ++k) {
      // the first sample after a phase is drawn, too: no gaps where the colour changes
      const bool is_in = is_drawn(k) || (k > first && is_drawn(k - 1));
      curve.add(is_in ? 1e3 * data.steps[k].wall_x : not_known,
                is_in ? unit.factor * force[k] : not_known);
    }
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
  if (top > 0.0) panel.y_max = 1.1 * top;
  if (has_fits) panel.curves.push_back(fit_curve(summary, unit.factor));
  page::Text caption = page::words(
      "run.fig04.paper", {{"periods", page::exact(cycles.loop().size())},
                          {"smoothing", page::exact_quantity(1e3 * cycles.smoothing, "ms")}});
  const ForceLaw& law = summary.law;
  if (has_fits)
    caption +=
        page::words("run.fig04.fits", {{"amplitude", page::quantity(law.active.amplitude, "N")},
                                       {"length", page::quantity(1e3 / law.active.rate, "mm")},
                                       {"active", page::number(law.active.r2)},
                                       {"line", page::number(law.active_line.r2)},
                                       {"offset", page::quantity(law.passive.offset, "N")},
                                       {"slope", page::quantity(-1e-3 * law.passive.slope, "N/mm")},
                                       {"passive", page::number(law.passive.r2)}});
  if (-summary.net.mean > 0.05 * summary.rise.mean)
    caption += page::words("run.fig04.side_by_side");
  return run_picture("fig04", 580, {panel}, caption);
}

Panel solid_fraction_panel(const RunData& data) {
  Panel panel = time_panel(data, "Δ*ρ*");
  panel.lines = {{paper_window.begin, "0.2 s", true}};
  return panel;
}

Curve solid_fraction_line(const RunData& data, const page::Text& title, Ink ink, double width) {
  auto change = record_column(data.steps, &StepRecord::solid_fraction);
  for (double& value : change) value -= data.facts.solid_fraction_initial;
  return line_of(record_column(data.steps, &StepRecord::time), change, title, ink, width);
}

std::vector<page::Picture> paper_figures(const RunData& data, const RunSummary& summary) {
  std::vector<page::Picture> figures;
  const bool has_packing = summary.facts.has_packing;
  if (summary.facts.has_wall) figures.push_back(figure_3(data, summary));
  if (has_packing && !summary.wall.periods.empty()) figures.push_back(figure_4(data, summary));
  if (has_packing) figures.push_back(figure_12(data, summary));
  return figures;
}

std::vector<page::Picture> diagnostic_figures(const RunData& data, const RunSummary& summary) {
  std::vector<page::Picture> figures;
  if (summary.facts.has_packing && !summary.wall.periods.empty())
    figures.push_back(jammed_figure(data, summary));
  figures.push_back(error_figure(data, summary));
  // a scene without any overlap has no logarithm of it to show
  if (summary.penetration_max > 0.0) figures.push_back(penetration_figure(data, summary));
  figures.push_back(effort_figure(data, summary));
  figures.push_back(energy_figure(data, summary));
  return figures;
}

}  // namespace ballast
