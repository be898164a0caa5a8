// The paper's fits on data whose answers are known.

#include "experiments/measure/fits.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a power law's interval covers the truth as often as it says") {
  Random random(3);
  int covered = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> x, y;
    for (const double nu : {1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 60.0}) {
      double gauss = -6.0;  // twelve uniform numbers: normal enough for this
      for (int k = 0; k < 12; ++k) gauss += random.uniform(0.0, 1.0);
      x.push_back(nu);
      y.push_back(0.3 * std::pow(nu, -2.0) * std::exp(0.1 * gauss));
    }
    const PowerFit fit = fit_power(x, y);
    CHECK(fit.half_width > 0.0);
    if (std::abs(fit.exponent + 2.0) <= fit.half_width) ++covered;
  }
  CHECK(covered > 0.92 * trials);
  CHECK(covered < 0.98 * trials);
}

TEST_CASE(
    "an exact power law is found exactly, and points that cannot have a logarithm are left out") {
  const std::vector<double> x{1, 2, 4, 8, 0, 3}, y{3, 0.75, 0.1875, 3.0 / 64.0, 5, -1};
  const PowerFit fit = fit_power(x, y);
  CHECK(fit.samples == 4);
  CHECK(fit.exponent == Approx(-2.0));
  CHECK(fit.prefactor == Approx(3.0));
  CHECK(fit.half_width < 1e-9);
}

TEST_CASE("sample means carry the standard error of independent samples") {
  const std::vector<double> values{1.0, 2.0, 3.0, not_known};
  const SampleMean mean = sample_mean(values);
  CHECK(mean.samples == 3);
  CHECK(mean.mean == Approx(2.0));
  CHECK(mean.error == Approx(1.0 / std::sqrt(3.0)));
  CHECK(std::isnan(sample_mean(std::vector<double>{4.0}).error));
  CHECK(std::isnan(sample_mean(std::vector<double>{}).mean));
}

TEST_CASE("a proportion through the origin is the geometric mean of the ratios") {
  const std::vector<double> x{1, 10, 100}, y{0.02, 0.1, 2.0};
  const Proportion fit = fit_proportion(x, y);
  CHECK(fit.factor == Approx(0.01 * std::cbrt(4.0)));
  CHECK(fit.low < fit.factor);
  CHECK(fit.high > fit.factor);
  CHECK(fit.spread == Approx(std::exp(std::log(2.0) / std::sqrt(3.0))));
}

TEST_CASE("Eq. 5 is found again, with an interval around its corner") {
  const std::vector<double> nu{1, 2, 3, 5, 7, 10, 15, 20, 30, 60};
  std::vector<double> rate;
  Random random(5);
  const double gain = 0.0025, critical = 9.0;
  for (const double f : nu)
    rate.push_back((f < critical ? gain * f : gain * critical * critical / f) *
                   (1.0 + random.uniform(-0.03, 0.03)));
  const PeakedRate fit = fit_peaked_rate(nu, rate);
  CHECK(fit.gain == Approx(gain).epsilon(0.04));
  CHECK(fit.critical == Approx(critical).epsilon(0.05));
  CHECK(fit.low < critical);
  CHECK(fit.high > critical);
  CHECK(fit.r2 > 0.98);
  CHECK(fit.at(4.5) == Approx(0.5 * fit.at(9.0)).epsilon(0.1));
  CHECK(std::isnan(fit_peaked_rate(std::vector<double>{1, 2}, std::vector<double>{1, 2}).critical));
}

TEST_CASE("Eq. 5 with its gain given leaves the corner alone to be fitted") {
  const std::vector<double> nu{1, 2, 5, 10, 20, 60};
  std::vector<double> rate;
  for (const double f : nu) rate.push_back(f < 9.0 ? 0.0025 * f : 0.0025 * 81.0 / f);
  const PeakedRate fit = fit_peaked_rate(nu, rate, 0.0025);
  CHECK(fit.gain == 0.0025);
  CHECK(fit.critical == Approx(9.0).epsilon(2e-3));
  // twice the gain wants an earlier corner, and misses the points
  const PeakedRate wrong = fit_peaked_rate(nu, rate, 0.005);
  CHECK(wrong.gain == 0.005);
  CHECK(wrong.critical < 8.0);
  CHECK(wrong.r2 < fit.r2);
}

TEST_CASE("Eq. 5 on a rate that only grows puts the corner at the end of the data") {
  const std::vector<double> nu{1, 2, 5, 10, 20}, rate{1, 2, 5, 10, 20};
  const PeakedRate fit = fit_peaked_rate(nu, rate);
  CHECK(fit.critical == Approx(20.0));
  CHECK(fit.gain == Approx(1.0));
}

TEST_CASE("chi^2 over its degrees of freedom: one when points scatter as their errors say") {
  Random random(11);
  std::vector<double> x, y, error, far;
  for (int k = 0; k < 400; ++k) {
    double gauss = -6.0;
    for (int j = 0; j < 12; ++j) gauss += random.uniform(0.0, 1.0);
    x.push_back(1.0 + 0.1 * k);
    y.push_back(2.0 / x.back() * (1.0 + 0.02 * gauss));
    error.push_back(0.02 * y.back());
    far.push_back(0.005 * y.back());
  }
  const PowerFit fit = fit_power(x, y);
  CHECK(reduced_chi2(fit, x, y, error) == Approx(1.0).epsilon(0.2));
  CHECK(reduced_chi2(fit, x, y, far) == Approx(16.0).epsilon(0.2));
  error.assign(400, not_known);
  CHECK(std::isnan(reduced_chi2(fit, x, y, error)));
}

TEST_CASE("chi^2 says whether points lie on a power law within their errors") {
  const std::vector<double> x{1, 2, 4, 8}, on{1, 0.25, 0.0625, 1.0 / 64.0};
  const auto shifted = [&](double by) {
    std::vector<double> y;
    for (size_t k = 0; k < x.size(); ++k)
      y.push_back(on[k] * std::exp(k == 0 || k == 3 ? by : -by));
    return y;
  };
  const auto chi2 = [&](const std::vector<double>& y, double relative) {
    std::vector<double> error;
    for (const double value : y) error.push_back(relative * value);
    return reduced_chi2(fit_power(x, y), x, y, error);
  };
  CHECK(chi2(on, 0.1) == Approx(0.0).margin(1e-12));
  CHECK(chi2(shifted(0.1), 0.1) ==
        Approx(2.0));  // four residuals of one error each over two degrees of freedom
  CHECK(chi2(shifted(0.1), 0.01) == Approx(200.0));
  CHECK(std::isnan(chi2(on, not_known)));
  CHECK(std::isnan(reduced_chi2(fit_power(x, on), x, on, std::vector<double>{0.1, 0.1})));
}
