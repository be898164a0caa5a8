// Fig. 9: Delta x_max and v_max against the frequency; exponents -2 and -1.

#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

struct Scaling {
  const char* name;  ///< of its words
  double Observation::*quantity;
  double expected;  ///< exponent of nu
  const char* y_label;
};
constexpr Scaling scalings[] = {
    {"rise", &Observation::rise, -2.0, "Δ{/:Italic x}_{max}  (mm)"},
    {"speed", &Observation::speed_in, -1.0, "{/:Italic v}_{max}  (mm/s)"}};

double geometric_mean(const std::vector<double>& values) {
  double logs = 0.0;
  for (const double value : values) logs += std::log(value) / static_cast<double>(values.size());
  return std::exp(logs);
}

/// Exponent over part of the frequencies.
PowerFit fit_part(const VariedCurve& curve, double low, double high) {
  VariedCurve part;
  for (size_t k = 0; k < curve.x.size(); ++k)
    if (curve.x[k] >= low && curve.x[k] <= high) {
      part.x.push_back(curve.x[k]);
      part.y.push_back(curve.y[k]);
    }
  return fit_power(part.x, part.y);
}

page::Table values_table(const std::vector<VariedValue>& values) {
  page::Table table = page::words_table("fig9.table");
  for (const VariedValue& value : values) {
    const SampleMean rise = value.mean(&Observation::rise),
                     speed = value.mean(&Observation::speed_in);
    const double nu = value.value;
    table.rows.push_back(
        {page::number(nu), samples_of(value) + " of " + std::to_string(value.planned),
         std::to_string(value.samples.front().periods), words_of(rise, 1e3), words_of(speed, 1e3),
         page::number(1e3 * rise.mean * nu * nu), page::number(1e3 * speed.mean * nu),
         page::number(value.mean(&Observation::error_mean).mean, 2)});
  }
  return table;
}

}  // namespace

PaperSection fig9_section(PaperData& data) {
  PaperSection section;
  const std::vector<VariedValue> values = read_values(data, Varied::frequency, section);
  if (values.size() < 2) return section;
  Figure figure{.height = 760};
  page::Values words{{"misfit", page::words("misfit")}};
  for (const auto& [name, quantity, expected, y_label] : scalings) {
    const VariedCurve curve = curve_of_values(values, quantity, 1e3);
    const PowerFit fit = fit_power(curve.x, curve.y);
    Panel& panel = figure.panels.emplace_back(frequency_panel(y_label));
    panel.log_y = true;
    panel.curves = power_law_curves(curve, fit, expected, geometric_mean(curve.x));
    const std::string of = name;
    words[of] = words_of(fit);
    const Misfit misfit = misfit_of(fit, curve);
    words[of + "_misfit"] = words_of(misfit);
    // Either part of the frequencies by itself: a law that bends has two exponents.
    words[of + "_low"] = words_of(fit_part(curve, 0.0, 10.0));
    words[of + "_high"] = words_of(fit_part(curve, 10.0, 1e9));
    section.claim("fig9." + of, words, PaperRange::exponent(expected), found(fit, misfit.p));
  }
  section.draw("fig9", figure, words);
  section.tables = {values_table(values)};
  return section;
}

}  // namespace ballast
