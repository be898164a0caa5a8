// Fig. 13, Eqs. 4 and 5: the compaction rate against the frequency.

#include "experiments/paper/sections.hpp"

namespace ballast {
namespace {

double relative_gain_of(const RunSummary& run) { return run.compaction.relative_gain; }

/// A window in which the rate is measured: the paper's, and one that is the same for all
/// frequencies.
struct RateWindow {
  const char *name, *title;  ///< of its words; in the legend
  RunMeasure rate;
  Ink ink;
  MarkShape shape;
};
constexpr RateWindow windows[] = {
    {"own", "paper’s window", rate_of, Ink::blue, MarkShape::circle},
    {"common", "0.4–1 s", common_rate_of, Ink::vermilion, MarkShape::square}};

constexpr double paper_peak = 10.0;  // nu_c [Hz]

/// Eq. 5 over the frequencies of a curve.
Curve law_curve(const PeakedRate& law, const Points& points, const char* title, Ink ink) {
  return curve_of([&](double nu) { return law.at(nu); }, {points.x.front(), points.x.back(), true},
                  title, ink);
}

/// How far Eq. 5 misses the rates, with `parameters` of it fitted.
Misfit misfit_of(const PeakedRate& law, const Points& points, int parameters) {
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
Found found_peak(const PeakedRate& fit, const Points& points, double law_p) {
  constexpr double no_bound = 1e9;
  return {.value = fit.critical,
          .low = fit.low < 1.05 * points.x.front() ? 0.0 : fit.low,
          .high = fit.high > 0.95 * points.x.back() ? no_bound : fit.high,
          .law_p = law_p};
}

/// Beyond the maximum the paper's rate falls as 1/nu.
void add_falling_branch(const Groups& groups, PaperSection& section) {
  Points falling;
  for (const Group& group : groups)
    if (group.value >= paper_peak) falling.add(group.value, group.mean(rate_of));
  const PowerFit fit = fit_power(falling.x, falling.y);
  const Misfit misfit = misfit_of(fit, falling);
  section.claim("fig13.falling", {{"exponent", words_of(fit)}, {"misfit", words_of(misfit)}},
                PaperRange::exponent(-1.0), found(fit, misfit.p));
}

}  // namespace

void fill_rates(PaperData& data, PaperSection& section) {
  const Groups groups = data.groups({"", {"frequency", "slowest"}}, frequency_of);
  Panel panel = frequency_panel("compaction rate  {/:Italic η}  (1/s)");
  page::Values words;
  // D as the paper has it: the gain of a period at 5 Hz over rho_0
  const Group* slow = at(groups, 5.0);
  const SampleMean gain = slow ? slow->mean(relative_gain_of) : SampleMean{};
  for (const RateWindow& window : windows) {
    const Points curve = points_of(groups, frequency_of, window.rate);
    if (curve.x.size() < 2) return;
    panel.curves.push_back(curve_of(curve, window.title, window.ink, window.shape));
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
    if (window.rate != rate_of) continue;
    if (std::isfinite(free.critical))
      panel.curves.push_back(law_curve(free, curve, "Eq. 5, both free", Ink::black));
    panel.curves.push_back(law_curve(fixed, curve, "Eq. 5, D = Δρ_1/ρ_0", Ink::green));
    panel.curves.push_back(law_curve({.gain = paper::gain_per_period, .critical = paper_peak},
                                     curve, "the paper’s Eq. 5", Ink::grey));
  }
  if (!slow) return;
  words["gain"] = words_of(gain);
  section.draw("fig13", {.height = 520, .panels = {panel}}, words);
  section.claim("fig13.gain", words, PaperRange::roughly(paper::gain_per_period), found(gain));
  add_falling_branch(groups, section);
}

}  // namespace ballast
