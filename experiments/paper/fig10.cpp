// Fig. 10: Delta x_max against the force amplitude, exponent -1; beside it gravity (+2) and the
// wall's mass, which Eq. 3 holds too.

#include <algorithm>
#include <cmath>

#include "experiments/paper/one_curve.hpp"

namespace ballast {
namespace {

/// The series of this section: their words, and the label of their axis.
constexpr struct {
  const char* name;
  Varied varied;
  const char* label;
} fig10_axes[] = {
    {"fig10", Varied::force, "{/:Italic f}_{max} / ({/:Italic m g})"},
    {"fig10_gravity", Varied::gravity, "{/:Italic g}  (m/s^2)"},
    {"fig10_mass", Varied::wall_mass, "{/:Italic m} / ({/:Italic m} + {/:Italic m}_w)"}};

const Series& series_of(Varied varied) {
  return *std::find_if(all_series().begin(), all_series().end(),
                       [&](const Series& series) { return series.varied == varied; });
}

/// Eq. 3 supposes f_max well above m g: the exponent over the larger loads alone.
PowerFit fit_strong(const VariedCurve& curve) {
  VariedCurve strong;
  for (size_t k = 0; k < curve.x.size(); ++k)
    if (curve.x[k] >= base_force) {
      strong.x.push_back(curve.x[k]);
      strong.y.push_back(curve.y[k]);
    }
  return fit_power(strong.x, strong.y);
}

}  // namespace

PaperSection fig10_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig10.intro"), page::words("misfit")}};
  for (const auto& axis : fig10_axes) {
    const double expected = series_of(axis.varied).exponent;
    const std::vector<VariedValue> values = read_values(data, axis.varied, section);
    if (values.size() < 2) continue;
    VariedCurve curve = curve_of_values(values, &Observation::rise, 1e3);
    for (size_t k = 0; k < values.size(); ++k) curve.x[k] = abscissa_of(values[k], axis.varied);
    const PowerFit fit = fit_power(curve.x, curve.y);
    const auto [low, high] = std::minmax_element(curve.x.begin(), curve.x.end());
    const Panel panel{.x_label = axis.label,
                      .y_label = "Δ{/:Italic x}_{max}  (mm)",
                      .log_x = true,
                      .log_y = true,
                      .curves = power_law_curves(curve, fit, expected, std::sqrt(*low * *high))};
    const Misfit misfit = misfit_of(fit, curve);
    const page::Values words{{"exponent", words_of(fit)},
                             {"misfit", words_of(misfit)},
                             {"strong", words_of(fit_strong(curve))},
                             {"frequency", page::number(varied_frequency)},
                             {"end", page::number(varied_duration)}};
    section.draw(axis.name, {.height = 440, .panels = {panel}}, words);
    section.claim(axis.name + std::string(".claim"), words, PaperRange::exponent(expected),
                  found(fit, misfit.p));
  }
  return section;
}

}  // namespace ballast
