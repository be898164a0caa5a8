// Fig. 13, Eqs. 4 and 5: the compaction rate against the frequency.

#include <algorithm>
#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

/// A window in which the rate is measured: the paper's, and one that is the same for all
/// frequencies.
struct RateWindow {
  const char *name, *title;  ///< of its words; in the legend
  double Observation::*rate;
  Ink ink;
  MarkShape shape;
};
constexpr RateWindow windows[] = {
    {"own", "paper’s window", &Observation::rate, Ink::blue, MarkShape::circle},
    {"common", "0.4–1 s", &Observation::rate_common, Ink::vermilion, MarkShape::square}};

constexpr double paper_peak = 10.0;  // nu_c [Hz]

VariedCurve known_points(const std::vector<VariedValue>& values, double Observation::*rate) {
  const VariedCurve all = curve_of_values(values, rate);
  VariedCurve known;
  for (size_t k = 0; k < all.x.size(); ++k) {
    if (!std::isfinite(all.y[k])) continue;
    known.x.push_back(all.x[k]);
    known.y.push_back(all.y[k]);
    known.error.push_back(all.error[k]);
    known.errors_from = all.errors_from;
    known.origins.push_back(all.origins[k]);
  }
  return known;
}

/// Eq. 5 over the frequencies of a curve.
Curve law_curve(const PeakedRate& law, const VariedCurve& points, const char* title, Ink ink) {
  return curve_of([&](double nu) { return law.at(nu); }, {points.x.front(), points.x.back(), true},
                  title, ink);
}

/// How far Eq. 5 misses the rates, with `parameters` of it fitted.
Misfit misfit_of(const PeakedRate& law, const VariedCurve& points, int parameters) {
  double misses = 0.0, variances = 0.0;
  const auto count = static_cast<double>(points.x.size());
  for (size_t k = 0; k < points.x.size(); ++k) {
    misses += std::pow(points.y[k] - law.at(points.x[k]), 2) / (count - parameters);
    variances += std::pow(points.error[k], 2) / count;
  }
  return {misses / variances, f_p(misses / variances, count - parameters, points.errors_from)};
}

page::Text words_of(const PeakedRate& fit) {
  return "ν_c = " + page::number(fit.critical) + " Hz " + page::interval(fit.low, fit.high) +
         ", Δρ_max/ρ₀ = " + page::number(fit.gain) + ", R² = " + page::number(fit.r2);
}

/// A corner at the end of the data is none: its interval is open on that side.
Found found_peak(const PeakedRate& fit, const VariedCurve& points, double law_p) {
  constexpr double no_bound = 1e9;
  return {.value = fit.critical,
          .low = fit.low < 1.05 * points.x.front() ? 0.0 : fit.low,
          .high = fit.high > 0.95 * points.x.back() ? no_bound : fit.high,
          .law_p = law_p};
}

/// Eq. 5 supposes that Delta rho_1 goes with Delta x_max [1/m].
SampleMean gain_over_rise(const VariedValue& value) {
  std::vector<double> ratios;
  for (const Observation& sample : value.samples) ratios.push_back(sample.gain / sample.rise);
  return sample_mean(ratios);
}

/// Beyond the maximum the paper's rate falls as 1/nu.
void add_falling_branch(const std::vector<VariedValue>& values, page::Values words,
                        PaperSection& section) {
  VariedCurve falling;
  for (const VariedValue& value : values) {
    if (value.value < paper_peak) continue;
    const SampleMean rate = value.mean(&Observation::rate);
    falling.x.push_back(value.value);
    falling.y.push_back(rate.mean);
    falling.error.push_back(rate.error);
    falling.errors_from += rate.samples - 1;
  }
  const PowerFit fit = fit_power(falling.x, falling.y);
  const Misfit misfit = ballast::misfit_of(fit, falling);
  words["exponent"] = words_of(fit);
  words["misfit"] = words_of(misfit);
  section.claim("fig13.falling", words, PaperRange::exponent(-1.0), found(fit, misfit.p));
}

}  // namespace

PaperSection fig13_section(PaperData& data) {
  PaperSection section{.text = {page::words("fig13.intro")}};
  const std::vector<VariedValue> values = read_values(data, Varied::frequency, section);
  Panel panel = frequency_panel("compaction rate  {/:Italic η}  (1/s)");
  page::Values words;
  // D as the paper has it: the gain of a period at 5 Hz over rho_0
  const auto slow = std::find_if(values.begin(), values.end(), [](const VariedValue& value) {
    return value.value == motion_frequency;
  });
  const SampleMean gain =
      slow == values.end() ? SampleMean{} : slow->mean(&Observation::relative_gain);
  for (const RateWindow& window : windows) {
    const VariedCurve curve = known_points(values, window.rate);
    if (curve.x.size() < 2) return {.notes = section.notes, .text = section.text};
    panel.curves.push_back(points_of(curve, window.title, window.ink));
    panel.curves.back().shape = window.shape;
    const std::string name = window.name;
    const PeakedRate free = fit_peaked_rate(curve.x, curve.y);
    const Misfit free_misfit = misfit_of(free, curve, 2);
    words[name] = words_of(free);
    words[name + "_misfit"] = words_of(free_misfit);
    section.claim("fig13." + name, words, PaperRange::roughly(paper_peak),
                  found_peak(free, curve, free_misfit.p));
    if (!std::isfinite(gain.mean)) continue;
    const PeakedRate fixed = fit_peaked_rate(curve.x, curve.y, gain.mean);
    const Misfit fixed_misfit = misfit_of(fixed, curve, 1);
    words[name + "_fixed"] = words_of(fixed);
    words[name + "_fixed_misfit"] = words_of(fixed_misfit);
    section.claim("fig13." + name + "_fixed", words, PaperRange::roughly(paper_peak),
                  found_peak(fixed, curve, fixed_misfit.p));
    if (window.rate != &Observation::rate) continue;
    if (std::isfinite(free.critical))
      panel.curves.push_back(law_curve(free, curve, "Eq. 5, both free", Ink::black));
    panel.curves.push_back(law_curve(fixed, curve, "Eq. 5, D = Δρ_1/ρ_0", Ink::green));
    panel.curves.push_back(law_curve({.gain = paper::gain_per_period, .critical = paper_peak},
                                     curve, "the paper’s Eq. 5", Ink::grey));
  }
  words["gain"] = words_of(gain);
  section.draw("fig13", {.height = 520, .panels = {panel}}, words);
  page::Table table = page::words_table("fig13.table");
  for (const VariedValue& value : values)
    table.rows.push_back(
        {page::number(value.value), samples_of(value), words_of(value.mean(&Observation::rate)),
         words_of(value.mean(&Observation::rate_common)),
         words_of(value.mean(&Observation::gain), 1e3), words_of(gain_over_rise(value)),
         page::number(value.mean(&Observation::solid_reference).mean, 4)});
  section.tables = {table};
  section.claim("fig13.gain", words, PaperRange::roughly(paper::gain_per_period), found(gain));
  add_falling_branch(values, words, section);
  return section;
}

}  // namespace ballast
