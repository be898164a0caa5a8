// Fig. 10: Delta x_max against the force amplitude, exponent -1; beside it gravity (+2) and the
// wall's mass, which Eq. 3 holds too.

#include <algorithm>
#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

struct Abscissa {
  const char* name;  ///< of the figure and its words
  Varied varied;
  const char* label;  ///< of the axis
  double exponent;    ///< as Eq. 3 has it
};
constexpr Abscissa abscissas[] = {
    {"fig10", Varied::force, "{/:Italic f}_{max} / {/:Italic m g}", -1.0},
    {"fig10_gravity", Varied::gravity, "{/:Italic g}  (m/s^2)", 2.0},
    {"fig10_mass", Varied::wall_mass, "{/:Italic m} / ({/:Italic m} + {/:Italic m}_w)", 1.0}};

/// x of the fit: f_max [N], g [m/s^2], or m/(m + m_w).
double abscissa_of(const VariedValue& value, Varied varied) {
  const RunFacts& facts = value.samples.front().facts;
  if (varied == Varied::gravity) return facts.gravity;
  if (varied == Varied::wall_mass) return facts.grain_mass / (facts.grain_mass + facts.wall_mass);
  return value.value;  // f_max over the weight under 9.81 m/s^2: the same for all seeds
}

}  // namespace

PaperSection fig10_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig10.intro"), page::words("misfit")}};
  for (const Abscissa& axis : abscissas) {
    const std::vector<VariedValue> values = read_values(data, axis.varied, section);
    if (values.size() < 2) continue;
    VariedCurve curve = curve_of_values(values, &Observation::rise, 1e3);
    for (size_t k = 0; k < values.size(); ++k) curve.x[k] = abscissa_of(values[k], axis.varied);
    const PowerFit fit = fit_power(curve.x, curve.y);
    const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
    const Panel panel{
        .x_label = axis.label,
        .y_label = "Δ{/:Italic x}_{max}  (mm)",
        .log_x = true,
        .log_y = true,
        .curves = power_law_curves(curve, fit, axis.exponent, std::sqrt(*low * *high))};
    const page::Values words{{"exponent", words_of(fit)},
                             {"misfit", misfit_words(fit, curve)},
                             {"frequency", page::number(varied_frequency)},
                             {"end", page::number(varied_duration)}};
    section.draw(axis.name, {.height = 440, .panels = {panel}}, words);
    section.claim(axis.name + std::string(".claim"), words, judge_exponent(fit, axis.exponent));
  }
  return section;
}

}  // namespace ballast
