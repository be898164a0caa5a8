// Fig. 8: phase portraits of the wall at 5 and 10 Hz, raw and scaled by nu^-2 and nu^-1.

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

constexpr int orbit_phases = 200;  // of a period, at which orbits are compared
constexpr double portrait_frequencies[] = {5.0, 10.0};

/// The mean orbit over the periods that count: displacement from the period's first jamming
/// position [m], velocity [m/s].
struct Orbit {
  std::vector<double> x = std::vector<double>(orbit_phases, 0.0), v = x;
  int periods = 0;
};

Orbit mean_orbit(const RunData& data) {
  const RunFacts& facts = data.facts;
  const WallCycles cycles = wall_cycles(data.steps, facts.frequency, facts.step);
  Orbit orbit;
  orbit.periods = static_cast<int>(cycles.periods.size());
  for (const WallPeriod& period : cycles.periods)
    for (size_t k = 0; k < orbit_phases; ++k) {
      // the same phase of the load in every period, whatever its number of steps
      const size_t sample = period.first + k * (period.last - period.first) / orbit_phases;
      orbit.x[k] += (data.steps[sample].wall_x - period.x_before) / orbit.periods;
      orbit.v[k] += cycles.velocity[sample] / orbit.periods;
    }
  return orbit;
}

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return *high - *low;
}

Orbit scaled(Orbit orbit, double x_factor, double v_factor) {
  for (double& x : orbit.x) x *= x_factor;
  for (double& v : orbit.v) v *= v_factor;
  return orbit;
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

/// Both orbits in mm and mm/s. They are open: a period ends further in than it began.
Panel portrait(const std::vector<Orbit>& orbits, const std::string& x_label,
               const std::string& v_label) {
  Panel panel{.x_label = x_label, .y_label = v_label};
  for (size_t k = 0; k < 2; ++k) {
    const Orbit shown = scaled(orbits[k], 1e3, 1e3);
    panel.curves.push_back({.x = shown.x,
                            .y = shown.v,
                            .title = plot_label(page::number(portrait_frequencies[k], 2) + " Hz"),
                            .ink = k == 0 ? Ink::blue : Ink::vermilion,
                            .dashed = k == 1});
  }
  return panel;
}

/// The orbits of one sample, raw and scaled by nu^-2 and nu^-1.
struct Portrait {
  std::vector<Orbit> raw, collapsed;
  double raw_distance() const { return distance(raw[0], raw[1]); }
  double collapsed_distance() const { return distance(collapsed[0], collapsed[1]); }
};

/// Of one sample's records at the two frequencies; none where one has no whole period.
std::optional<Portrait> portrait_of(const RunData& slow, const RunData& fast) {
  Portrait result;
  for (const RunData* data : {&slow, &fast}) {
    const Orbit orbit = mean_orbit(*data);
    if (orbit.periods == 0) return {};
    const double nu = data->facts.frequency;
    result.raw.push_back(orbit);
    result.collapsed.push_back(scaled(orbit, nu * nu, nu));
  }
  return result;
}

}  // namespace

void fill_portraits(PaperData& data, PaperSection& section) {
  std::vector<double> raw, collapsed;
  std::optional<Portrait> shown;
  const std::vector<RunData> fast = data.records("frequency", portrait_frequencies[1]);
  for (const RunData& slow : data.records("frequency", portrait_frequencies[0])) {
    const auto same = std::ranges::find_if(
        fast, [&](const RunData& other) { return other.facts.seed == slow.facts.seed; });
    if (same == fast.end()) continue;
    const std::optional<Portrait> seen = portrait_of(slow, *same);
    if (!seen) continue;
    raw.push_back(seen->raw_distance());
    collapsed.push_back(seen->collapsed_distance());
    if (!shown) shown = seen;
  }
  if (!shown) {
    section.notes.push_back("PARTIAL: the records at 5 and 10 Hz are not both there.");
    return;
  }
  // Where x goes with nu^-2 and v with nu^-1 the scaled orbits are one.
  const SampleMean after = sample_mean(collapsed);
  const page::Values words{{"samples", std::to_string(raw.size())},
                           {"slow", std::to_string(shown->raw[0].periods)},
                           {"fast", std::to_string(shown->raw[1].periods)},
                           {"raw", words_of(sample_mean(raw))},
                           {"scaled", words_of(after)}};
  section.draw("fig8",
               {.height = 860,
                .panels = {portrait(shown->raw, "{/:Italic x} − {/:Italic x}_{jam}  (mm)",
                                    "{/:Italic v}  (mm/s)"),
                           portrait(shown->collapsed,
                                    "({/:Italic x} − {/:Italic x}_{jam}) {/:Italic ν}^2  (mm/s^2)",
                                    "{/:Italic v ν}  (mm/s^2)")}},
               words);
  section.claim("fig8.collapse", words, PaperRange::at_most(0.1), found(after));
}

}  // namespace ballast
