// Fig. 8: phase portraits of the wall at 5 and 10 Hz, raw and scaled by nu^-2 and nu^-1.

#include <algorithm>
#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

constexpr int orbit_phases = 200;  // of a period, at which orbits are compared

/// The mean orbit over the periods that count: displacement from the period's first jamming
/// position [m], velocity [m/s].
struct Orbit {
  std::vector<double> x, v;
  int periods = 0;
};

Orbit mean_orbit(const RunData& data) {
  const RunFacts facts = complete_facts(data.facts, data.steps);
  const WallCycles cycles = wall_cycles(data.steps, facts.frequency, facts.step);
  Orbit orbit;
  orbit.x.assign(orbit_phases, 0.0);
  orbit.v.assign(orbit_phases, 0.0);
  orbit.periods = static_cast<int>(cycles.periods.size());
  for (const WallPeriod& period : cycles.periods)
    for (int k = 0; k < orbit_phases; ++k) {
      const size_t sample =
          period.first + static_cast<size_t>(k) * (period.last - period.first) / orbit_phases;
      orbit.x[static_cast<size_t>(k)] +=
          (data.steps[sample].wall_x - period.x_before) / orbit.periods;
      orbit.v[static_cast<size_t>(k)] += cycles.velocity[sample] / orbit.periods;
    }
  return orbit;
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

Orbit scaled(const Orbit& orbit, double x_factor, double v_factor) {
  Orbit result = orbit;
  for (double& x : result.x) x *= x_factor;
  for (double& v : result.v) v *= v_factor;
  return result;
}

/// rms over orbit_phases of the distance, each axis in units of the mean range of the two.
double distance(const Orbit& a, const Orbit& b) {
  const double x_range = 0.5 * (range_of(a.x) + range_of(b.x)),
               v_range = 0.5 * (range_of(a.v) + range_of(b.v));
  double sum = 0.0;
  for (size_t k = 0; k < orbit_phases; ++k)
    sum += (std::pow((a.x[k] - b.x[k]) / x_range, 2) + std::pow((a.v[k] - b.v[k]) / v_range, 2)) /
           orbit_phases;
  return std::sqrt(sum);
}

Panel portrait(const std::vector<std::pair<Orbit, double>>& orbits, const std::string& x_label,
               const std::string& v_label, double x_unit, double v_unit) {
  Panel panel;
  panel.x_label = x_label;
  panel.y_label = v_label;
  const Ink inks[] = {Ink::blue, Ink::vermilion};
  for (size_t k = 0; k < orbits.size(); ++k) {
    Orbit shown = scaled(orbits[k].first, x_unit, v_unit);
    shown.x.push_back(shown.x.front());
    shown.v.push_back(shown.v.front());
    Curve curve;
    curve.x = shown.x;
    curve.y = shown.v;
    curve.title = plot_label(page::number(orbits[k].second, 2) + " Hz");
    curve.ink = inks[k % 2];
    curve.dashed = k == 1;
    panel.curves.push_back(curve);
  }
  return panel;
}

}  // namespace

PaperSection fig8_section(PaperData& data) {
  PaperSection section;
  const auto slow = data.at_frequency(motion_frequency),
             fast = data.at_frequency(2.0 * motion_frequency);
  if (!slow || !fast) {
    section.notes = {"PARTIAL: the runs at 5 and 10 Hz are not both there yet."};
    return section;
  }
  const double nu[] = {motion_frequency, 2.0 * motion_frequency};
  const std::vector<std::pair<Orbit, double>> raw = {{mean_orbit(data.read(*slow)), nu[0]},
                                                     {mean_orbit(data.read(*fast)), nu[1]}};
  if (raw[0].first.periods == 0 || raw[1].first.periods == 0) {
    section.notes = {"PARTIAL: no whole period after the transient."};
    return section;
  }
  std::vector<std::pair<Orbit, double>> collapsed;
  for (size_t k = 0; k < 2; ++k)
    collapsed.emplace_back(scaled(raw[k].first, nu[k] * nu[k], nu[k]), nu[k]);
  const double before = distance(raw[0].first, raw[1].first),
               after = distance(collapsed[0].first, collapsed[1].first);
  PaperFigure figure;
  figure.plot.name = "fig08";
  figure.plot.title = "Phase portraits of the wall at 5 and 10 Hz, raw and scaled";
  figure.plot.height = 860;
  figure.plot.panels = {
      portrait(raw, "{/:Italic x} − {/:Italic x}_{jam}  (mm)", "{/:Italic v}  (mm/s)", 1e3, 1e3),
      portrait(collapsed, "({/:Italic x} − {/:Italic x}_{jam}) {/:Italic ν}^2  (mm/s^2)",
               "{/:Italic v ν}  (mm/s^2)", 1e3, 1e3)};
  figure.paper = page::words("fig8.paper");
  figure.found = page::words("fig8.found", {{"slow", std::to_string(raw[0].first.periods)},
                                            {"fast", std::to_string(raw[1].first.periods)},
                                            {"raw", page::number(before)},
                                            {"scaled", page::number(after)}});
  section.figures = {figure};
  section.rows = {{"Fig. 8", "orbits at 5 and 10 Hz collapse",
                   "distance raw " + page::number(before) + ", scaled " + page::number(after) +
                       " of the orbit’s size",
                   after < 0.1            ? Agreement::agrees
                   : after < 0.5 * before ? Agreement::partly
                                          : Agreement::differs}};
  return section;
}

}  // namespace ballast
