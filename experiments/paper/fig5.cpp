// Fig. 5: the phenomenological model. f_g(x) as fitted in Fig. 4 is put into Eq. 2 and integrated
// over one period.

#include <algorithm>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/motion.hpp"
#include "experiments/paper/wall_model.hpp"
#include "experiments/run_page/figures.hpp"

namespace ballast {
namespace {

WallModel model_of(const RunSummary& s) {
  WallModel model;
  model.active = s.loop.active;
  model.passive = s.loop.passive;
  model.contraction = std::max(0.0, -s.net.mean);
  model.wall_mass = s.facts.wall_mass;
  model.load = {s.facts.f_min, s.facts.f_max, s.facts.frequency};
  return model;
}

/// Where a period's wall leaves the unjamming transient: the fits begin at this part of the rise
/// too.
std::optional<ModelStart> after_unjamming(const MotionRun& run, const WallPeriod& period) {
  const double begin = WallSettings{}.fit_from * period.rise;
  for (size_t k = period.peak; k-- > period.first;) {
    const double x = run.data.steps[k].wall_x - period.x_before;
    if (x <= begin)
      return ModelStart{run.data.steps[k].time - period.begin, x, run.summary.wall.velocity[k]};
  }
  return {};
}

/// The model beside one run: from the jam, and taken up after the unjamming transient of each
/// period (means over periods).
struct Modelled {
  double rise_from_jam = not_known, rise = not_known, speed_in = not_known;
  ModelMotion last;  ///< of the last period
};

Modelled modelled(const MotionRun& run) {
  const WallModel model = model_of(run.summary);
  Modelled result;
  result.rise_from_jam = integrate(model).rise;
  std::vector<double> rises, speeds;
  for (const WallPeriod& period : run.summary.wall.periods) {
    const auto start = after_unjamming(run, period);
    if (!start) continue;
    result.last = integrate(model, start);
    rises.push_back(result.last.rise);
    speeds.push_back(result.last.speed_in);
  }
  result.rise = statistics(rises).mean;
  result.speed_in = statistics(speeds).mean;
  return result;
}

bool can_be_modelled(const RunSummary& s) {
  return !s.wall.periods.empty() && std::isfinite(s.loop.active.rate) &&
         std::isfinite(s.loop.passive.slope) && std::isfinite(s.facts.wall_mass);
}

Curve line(std::vector<double> x, std::vector<double> y, const char* title, Ink ink, bool dashed) {
  Curve curve = line_of(std::move(x), std::move(y), title, ink, 2.0);
  curve.dashed = dashed;
  return curve;
}

/// The last period: x from the jamming position [mm], v [mm/s], f_g smoothed [kN or N].
struct LastPeriod {
  std::vector<double> time, x, v, force;
};

LastPeriod last_period(const MotionRun& run, double unit) {
  const WallPeriod& period = run.summary.wall.periods.back();
  LastPeriod result;
  for (size_t k = period.first; k < period.last; ++k) {
    result.time.push_back(run.data.steps[k].time - period.begin);
    result.x.push_back(1e3 * (run.data.steps[k].wall_x - period.x_before));
    result.v.push_back(1e3 * run.summary.wall.velocity[k]);
    result.force.push_back(unit * run.summary.wall.force[k]);
  }
  return result;
}

std::vector<double> times(const std::vector<double>& values, double factor) {
  std::vector<double> result;
  for (const double value : values) result.push_back(factor * value);
  return result;
}

Figure draw(const MotionRun& run, const ModelMotion& model) {
  const ForceUnit unit = force_unit(run.summary.facts.f_max);
  const LastPeriod seen = last_period(run, unit.factor);
  Panel above, below;
  above.x_label = "{/:Italic t} in the period  (s)";
  above.y_label = "{/:Italic x} − {/:Italic x}_{jam}  (mm)";
  above.curves = {line(seen.time, seen.x, "simulation", Ink::blue, false),
                  line(model.time, times(model.x, 1e3), "model", Ink::black, true)};
  below.x_label = "{/:Italic v}  (mm/s)";
  below.y_label = std::string("{/:Italic f}_g  (") + unit.name + ")";
  Curve loop;
  loop.x = seen.v;
  loop.y = seen.force;
  loop.title = "simulation";
  Curve model_loop;
  for (size_t k = 0; k < model.v.size(); k += 20) {
    model_loop.x.push_back(1e3 * model.v[k]);
    model_loop.y.push_back(unit.factor * model.force[k]);
  }
  model_loop.title = "model";
  model_loop.ink = Ink::black;
  model_loop.dashed = true;
  below.curves = {loop, model_loop};
  Figure figure;
  figure.name = "fig05";
  figure.title = "One period: displacement against time and force against velocity, with the model";
  figure.height = 760;
  figure.panels = {above, below};
  return figure;
}

}  // namespace

PaperSection fig5_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("fig5.intro")};
  const std::vector<MotionRun> runs = read_motion(data, section);
  page::Table table{
      "Model beside simulation (means over periods), sample by sample",
      {"sample", "Δx_max simulated (mm)", "model (mm)", "deviation", "model from the jam (mm)",
       "v_max simulated (mm/s)", "model (mm/s)", "deviation"},
      {}};
  std::vector<double> rises, from_jam, speeds;
  for (size_t k = 0; k < runs.size(); ++k) {
    const RunSummary& s = runs[k].summary;
    if (!can_be_modelled(s)) continue;
    const Modelled model = modelled(runs[k]);
    rises.push_back(model.rise / s.rise.mean - 1.0);
    from_jam.push_back(model.rise_from_jam / s.rise.mean - 1.0);
    speeds.push_back(model.speed_in / s.speed_in.mean - 1.0);
    table.rows.push_back({std::to_string(k + 1), page::number(1e3 * s.rise.mean),
                          page::number(1e3 * model.rise), page::percent(rises.back()),
                          page::number(1e3 * model.rise_from_jam),
                          page::number(1e3 * s.speed_in.mean), page::number(1e3 * model.speed_in),
                          page::percent(speeds.back())});
    if (!section.figures.empty() || model.last.time.empty()) continue;
    PaperFigure figure;
    figure.plot = draw(runs[k], model.last);
    figure.paper = page::words("fig5.paper");
    section.figures.push_back(figure);
  }
  const SampleMean rise = sample_mean(rises), speed = sample_mean(speeds),
                   jam = sample_mean(from_jam);
  if (rise.samples == 0 || section.figures.empty()) return section;
  section.figures.front().found = page::words("fig5.found", {{"sample", table.rows.front().front()},
                                                             {"rise", page::percent(rise.mean)},
                                                             {"speed", page::percent(speed.mean)},
                                                             {"jam", page::percent(jam.mean)}});
  section.tables = {table};
  section.rows = {
      {"Fig. 5", "model’s Δx_max close to the simulation’s, transients excluded (asked for: 15 %)",
       page::percent(rise.mean) + " (from the jam: " + page::percent(jam.mean) + ")",
       std::abs(rise.mean) <= 0.15  ? Agreement::agrees
       : std::abs(rise.mean) <= 0.3 ? Agreement::partly
                                    : Agreement::differs},
      {"Fig. 5", "model under-estimates the largest contraction velocity",
       page::percent(speed.mean), speed.mean < 0.0 ? Agreement::agrees : Agreement::differs}};
  return section;
}

}  // namespace ballast
