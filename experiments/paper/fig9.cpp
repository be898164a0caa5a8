// Fig. 9: Delta x_max and v_max against the frequency; exponents -2 and -1.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

Panel scaling_panel(const VariedCurve& curve, const PowerFit& fit, double expected,
                    const std::string& y_label) {
  Panel panel = frequency_panel(y_label);
  panel.log_y = true;
  panel.curves = {
      points_of(curve.x, curve.y, curve.error, "mean over samples ± standard error", Ink::blue)};
  if (!std::isfinite(fit.exponent)) return panel;
  const double low = curve.x.front(), high = curve.x.back();
  panel.curves.push_back(curve_of([&](double nu) { return fit.at(nu); }, low, high, true,
                                  "fit, exponent " + plot_label(page::number(fit.exponent)),
                                  Ink::black));
  // through the data's geometric middle
  double logs = 0.0;
  for (size_t k = 0; k < curve.x.size(); ++k)
    logs +=
        std::log(curve.y[k] / std::pow(curve.x[k], expected)) / static_cast<double>(curve.x.size());
  panel.curves.push_back(curve_of(
      [&](double nu) { return std::exp(logs) * std::pow(nu, expected); }, low, high, true,
      "the paper’s exponent " + plot_label(page::number(expected, 1)), Ink::vermilion, false));
  return panel;
}

/// Exponent over part of the frequencies.
PowerFit fit_part(const VariedCurve& curve, double low, double high) {
  std::vector<double> x, y;
  for (size_t k = 0; k < curve.x.size(); ++k)
    if (curve.x[k] >= low && curve.x[k] <= high) x.push_back(curve.x[k]), y.push_back(curve.y[k]);
  return fit_power(x, y);
}

page::Table values_table(const std::vector<VariedValue>& values) {
  page::Table table;
  table.caption = "Means over samples ± standard error";
  table.head = {"ν (Hz)",       "samples",           "periods each",    "Δx_max (mm)",
                "v_max (mm/s)", "Δx_max ν² (mm/s²)", "v_max ν (mm/s²)", "error (g·h)"};
  for (const VariedValue& value : values) {
    const SampleMean rise = value.mean(&Observation::rise),
                     speed = value.mean(&Observation::speed_in);
    const double nu = value.value;
    table.rows.push_back(
        {page::number(nu),
         std::to_string(value.samples.size()) + " of " + std::to_string(value.planned),
         std::to_string(value.samples.front().periods),
         page::with_error(1e3 * rise.mean, 1e3 * rise.error),
         page::with_error(1e3 * speed.mean, 1e3 * speed.error),
         page::number(1e3 * rise.mean * nu * nu), page::number(1e3 * speed.mean * nu),
         page::number(value.mean(&Observation::error_mean).mean, 2)});
  }
  return table;
}

}  // namespace

PaperSection fig9_section(PaperData& data) {
  PaperSection section;
  const std::vector<VariedValue> values = data.values(Varied::frequency);
  note_missing(data, Varied::frequency, "frequencies", section);
  if (values.size() < 2) return section;
  const VariedCurve rise = curve_of_values(values, &Observation::rise, 1e3),
                    speed = curve_of_values(values, &Observation::speed_in, 1e3);
  const PowerFit rise_fit = fit_power(rise.x, rise.y), speed_fit = fit_power(speed.x, speed.y);
  PaperFigure figure;
  figure.plot.name = "fig09";
  figure.plot.title = "Maximum displacement and maximum velocity against frequency";
  figure.plot.height = 760;
  figure.plot.panels = {scaling_panel(rise, rise_fit, -2.0, "Δ{/:Italic x}_{max}  (mm)"),
                        scaling_panel(speed, speed_fit, -1.0, "{/:Italic v}_{max}  (mm/s)")};
  figure.paper = page::words("fig9.paper");
  figure.found = page::words("fig9.found", {{"rise", words_of(rise_fit)},
                                            {"rise_misfit", misfit_words(rise_fit, rise)},
                                            {"speed", words_of(speed_fit)},
                                            {"speed_misfit", misfit_words(speed_fit, speed)},
                                            {"misfit", page::words("misfit")},
                                            {"rise_low", words_of(fit_part(rise, 0.0, 10.0))},
                                            {"rise_high", words_of(fit_part(rise, 10.0, 1e9))},
                                            {"speed_low", words_of(fit_part(speed, 0.0, 10.0))},
                                            {"speed_high", words_of(fit_part(speed, 10.0, 1e9))}});
  section.figures = {figure};
  section.tables = {values_table(values)};
  section.rows = {
      {"Fig. 9", "Δx_max ~ ν^−2", words_of(rise_fit) + ", " + misfit_words(rise_fit, rise),
       judge_exponent(rise_fit, -2.0)},
      {"Fig. 9", "v_max ~ ν^−1", words_of(speed_fit) + ", " + misfit_words(speed_fit, speed),
       judge_exponent(speed_fit, -1.0)}};
  return section;
}

}  // namespace ballast
