// Fig. 13, Eqs. 4 and 5: the compaction rate against the frequency.

#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// A window in which the rate is measured: the paper's, and one that is the same for all
/// frequencies.
struct RateWindow {
  const char* name;  ///< of its words
  double Observation::*rate;
  const char* y_label;
};
constexpr RateWindow windows[] = {{"own", &Observation::rate, "rate, paper’s window  (1/s)"},
                                  {"common", &Observation::rate_common, "rate, 0.4–1 s  (1/s)"}};

constexpr double least_r2 = 0.5;  // Eq. 5 must say more than the mean does

VariedCurve known_points(const std::vector<VariedValue>& values, double Observation::*rate) {
  const VariedCurve all = curve_of_values(values, rate);
  VariedCurve known;
  for (size_t k = 0; k < all.x.size(); ++k) {
    if (!std::isfinite(all.y[k])) continue;
    known.x.push_back(all.x[k]);
    known.y.push_back(all.y[k]);
    known.error.push_back(all.error[k]);
  }
  return known;
}

Panel rate_panel(const VariedCurve& curve, const PeakedRate& fit, const std::string& y_label) {
  Panel panel = frequency_panel(y_label);
  panel.curves = {points_of(curve, mean_title, Ink::blue)};
  const Drawn range{curve.x.front(), curve.x.back(), true};
  const auto add = [&](const PeakedRate& law, const char* title, Ink ink) {
    panel.curves.push_back(curve_of([&](double nu) { return law.at(nu); }, range, title, ink));
  };
  if (std::isfinite(fit.critical)) add(fit, "Eq. 5 fitted", Ink::black);
  add({.gain = paper::gain_per_period, .critical = 10.0}, "the paper’s Eq. 5", Ink::grey);
  return panel;
}

page::Text words_of(const PeakedRate& fit) {
  return "ν_c = " + page::number(fit.critical) + " Hz " + page::interval(fit.low, fit.high) +
         ", Δρ_max/ρ₀ = " + page::number(fit.gain) + ", R² = " + page::number(fit.r2);
}

Agreement judge_peak(const VariedCurve& curve, const PeakedRate& fit) {
  if (fit.samples < 5) return Agreement::reported;
  // a corner at the end of the data is none
  const bool has_peak = std::isfinite(fit.critical) && fit.critical > 1.05 * curve.x.front() &&
                        fit.critical < 0.95 * curve.x.back() && fit.high < 0.95 * curve.x.back();
  const bool is_peak = has_peak && fit.r2 > least_r2;
  return graded(is_peak && fit.critical > 7.0 && fit.critical < 14.0, is_peak);
}

Agreement judge_gain(const PeakedRate& fit) {
  const bool is_fit = fit.r2 > least_r2;
  return graded(is_fit && fit.gain > 0.00167 && fit.gain < 0.00375,
                is_fit && fit.gain > 0.0008 && fit.gain < 0.0075);
}

}  // namespace

PaperSection fig13_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig13.intro")}};
  const std::vector<VariedValue> values = read_values(data, Varied::frequency, section);
  Figure figure{.height = 760};
  page::Values words;
  PeakedRate own;
  for (const RateWindow& window : windows) {
    const VariedCurve curve = known_points(values, window.rate);
    if (curve.x.size() < 2) return {.notes = section.notes, .text = section.text};
    const PeakedRate fit = fit_peaked_rate(curve.x, curve.y);
    if (window.rate == &Observation::rate) own = fit;
    figure.panels.push_back(rate_panel(curve, fit, window.y_label));
    words[window.name] = words_of(fit);
    section.claim(std::string("fig13.") + window.name, words, judge_peak(curve, fit));
  }
  section.draw("fig13", figure, words);
  page::Table table = page::words_table("fig13.table");
  for (const VariedValue& value : values)
    table.rows.push_back({page::number(value.value), samples_of(value),
                          words_of(value.mean(&Observation::rate)),
                          words_of(value.mean(&Observation::rate_common)),
                          words_of(value.mean(&Observation::gain), 1e3),
                          page::number(value.mean(&Observation::solid_reference).mean, 4)});
  section.tables = {table};
  section.claim("fig13.gain", {{"gain", page::number(own.gain)}}, judge_gain(own));
  return section;
}

}  // namespace ballast
