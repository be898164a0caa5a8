// Fig. 13, Eqs. 4 and 5: the compaction rate against the frequency.

#include <cmath>

#include "experiments/page/page.hpp"
#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

Panel rate_panel(const VariedCurve& curve, const PeakedRate& fit, const std::string& y_label) {
  Panel panel = frequency_panel(y_label);
  panel.curves = {
      points_of(curve.x, curve.y, curve.error, "mean over samples ± standard error", Ink::blue)};
  const double low = curve.x.front(), high = curve.x.back();
  if (std::isfinite(fit.critical))
    panel.curves.push_back(curve_of([&](double nu) { return fit.at(nu); }, low, high, true,
                                    "Eq. 5 fitted", Ink::black));
  const PeakedRate paper{0.0025, 10.0, not_known, not_known, not_known, 0};
  panel.curves.push_back(curve_of([&](double nu) { return paper.at(nu); }, low, high, true,
                                  "the paper’s Eq. 5", Ink::grey));
  return panel;
}

page::Text words_of(const PeakedRate& fit) {
  return "ν_c = " + page::number(fit.critical) + " Hz " + page::interval(fit.low, fit.high) +
         ", Δρ_max/ρ₀ = " + page::number(fit.gain) + ", R² = " + page::number(fit.r2);
}

/// A corner at the end of the data is none.
bool has_peak(const VariedCurve& curve, const PeakedRate& fit) {
  return std::isfinite(fit.critical) && fit.critical > 1.05 * curve.x.front() &&
         fit.critical < 0.95 * curve.x.back() && fit.high < 0.95 * curve.x.back();
}

void drop_unknown(VariedCurve& curve) {
  VariedCurve known;
  for (size_t k = 0; k < curve.x.size(); ++k) {
    if (!std::isfinite(curve.y[k])) continue;
    known.x.push_back(curve.x[k]);
    known.y.push_back(curve.y[k]);
    known.error.push_back(curve.error[k]);
  }
  curve = known;
}

}  // namespace

PaperSection fig13_section(PaperData& data) {
  PaperSection section;
  section.text = {page::words("fig13.intro")};
  const std::vector<VariedValue> values = data.values(Varied::frequency);
  note_missing(data, Varied::frequency, "frequencies", section);
  VariedCurve whole = curve_of_values(values, &Observation::rate),
              common = curve_of_values(values, &Observation::rate_common);
  drop_unknown(whole);
  drop_unknown(common);
  if (whole.x.size() < 2 || common.x.size() < 2) return section;
  const PeakedRate fit = fit_peaked_rate(whole.x, whole.y),
                   common_fit = fit_peaked_rate(common.x, common.y);
  PaperFigure figure;
  figure.plot.name = "fig13";
  figure.plot.title = "Compaction rate against frequency";
  figure.plot.height = 760;
  figure.plot.panels = {rate_panel(whole, fit, "rate, paper’s window  (1/s)"),
                        rate_panel(common, common_fit, "rate, 0.4–1 s  (1/s)")};
  figure.paper = page::words("fig13.paper");
  figure.found =
      page::words("fig13.found", {{"own", words_of(fit)}, {"common", words_of(common_fit)}});
  section.figures = {figure};
  page::Table table{"Compaction rate, means over samples ± standard error",
                    {"ν (Hz)", "samples", "rate, paper’s window (1/s)", "rate, 0.4–1 s (1/s)",
                     "Δρ₁ (10⁻³)", "ρ₀"},
                    {}};
  for (const VariedValue& value : values) {
    const SampleMean rate = value.mean(&Observation::rate),
                     rate_common = value.mean(&Observation::rate_common),
                     gain = value.mean(&Observation::gain);
    table.rows.push_back({page::number(value.value), std::to_string(value.samples.size()),
                          page::with_error(rate.mean, rate.error),
                          page::with_error(rate_common.mean, rate_common.error),
                          page::with_error(1e3 * gain.mean, 1e3 * gain.error),
                          page::number(value.mean(&Observation::solid_reference).mean, 4)});
  }
  section.tables = {table};
  const auto judge = [&](const VariedCurve& curve, const PeakedRate& peak) {
    if (peak.samples < 5) return Agreement::reported;
    if (!has_peak(curve, peak) || !(peak.r2 > 0.5))
      return Agreement::differs;  // Eq. 5 must say more than the mean does
    return peak.critical > 7.0 && peak.critical < 14.0 ? Agreement::agrees : Agreement::partly;
  };
  section.rows = {
      {"Fig. 13", "maximum at ν_c ~ 10 Hz", words_of(fit), judge(whole, fit)},
      {"Fig. 13", "the same, 0.4–1 s for all", words_of(common_fit), judge(common, common_fit)},
      {"Eq. 5", "Δρ_max/ρ₀ ~ 0.0025", page::number(fit.gain),
       !(fit.r2 > 0.5)                            ? Agreement::differs
       : fit.gain > 0.00167 && fit.gain < 0.00375 ? Agreement::agrees
       : fit.gain > 0.0008 && fit.gain < 0.0075   ? Agreement::partly
                                                  : Agreement::differs}};
  return section;
}

}  // namespace ballast
