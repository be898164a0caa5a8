// What the sections on scaling share.

#include <algorithm>
#include <cmath>

#include "experiments/paper/sections.hpp"

namespace ballast {

std::vector<VariedValue> read_values(PaperData& data, Varied varied, PaperSection& section) {
  if (const std::string missing = data.missing(varied); !missing.empty())
    section.notes.push_back(missing);
  return data.values(varied);
}

VariedCurve curve_of_values(const std::vector<VariedValue>& values, double Observation::*quantity,
                            double factor) {
  VariedCurve curve;
  for (const VariedValue& value : values) {
    const SampleMean mean = value.mean(quantity);
    curve.x.push_back(value.value);
    curve.origins.push_back(value.origin());
    curve.y.push_back(factor * mean.mean);
    curve.error.push_back(factor * mean.error);
    curve.errors_from += std::max(0, mean.samples - 1);
  }
  return curve;
}

SampleMean prefactor_of(const VariedValue& value) {
  std::vector<double> factors;
  for (const Observation& sample : value.samples) factors.push_back(sample.rise / sample.eq3());
  return sample_mean(factors);
}

page::Text words_of(const SampleMean& mean, double factor) {
  return page::with_error(factor * mean.mean, factor * mean.error);
}

page::Text samples_of(const VariedValue& value) { return std::to_string(value.samples.size()); }

page::Text words_of(const PowerFit& fit) {
  if (!std::isfinite(fit.exponent)) return "–";
  page::Text text = page::number(fit.exponent);
  if (std::isfinite(fit.half_width))
    text += std::string(" ") +
            page::interval(fit.exponent - fit.half_width, fit.exponent + fit.half_width);
  return text + " (R² " + page::number(fit.r2, 4) + ", " + std::to_string(fit.samples) + " points)";
}

Misfit misfit_of(const PowerFit& fit, const VariedCurve& curve) {
  const double reduced = reduced_chi2(fit, curve.x, curve.y, curve.error);
  // the errors come from few samples: a ratio of two variances, not chi^2 of known errors
  return {reduced, f_p(reduced, fit.samples - 2, curve.errors_from)};
}

page::Text words_of(const Misfit& misfit) {
  return "χ²/dof " + page::number(misfit.reduced, 2) + ", p " + words_of_p(misfit.p);
}

page::Text words_of_p(double p) { return p < 1e-4 ? page::Text("< 1e-4") : page::number(p, 2); }

std::vector<Curve> power_law_curves(const VariedCurve& points, const PowerFit& fit, double expected,
                                    double middle) {
  std::vector<Curve> curves{points_of(points, mean_title, Ink::blue)};
  if (!std::isfinite(fit.exponent)) return curves;
  const auto [low, high] = std::minmax_element(points.x.begin(), points.x.end());
  const Drawn range{*low, *high, true};
  curves.push_back(curve_of([&](double x) { return fit.at(x); }, range,
                            "fit, exponent " + plot_label(page::number(fit.exponent)), Ink::black));
  curves.push_back(curve_of(
      [&](double x) { return fit.at(middle) * std::pow(x / middle, expected); }, range,
      "the paper’s exponent " + plot_label(page::number(expected, 1)), Ink::vermilion, false));
  return curves;
}

}  // namespace ballast
