#include "experiments/measure/curve_fit.hpp"

#include <cmath>
#include <numbers>

#include "platform/random.hpp"
#include "tests/catch.hpp"

namespace ballast {
namespace {

std::vector<double> grid(double from, double to, int count) {
  std::vector<double> x;
  for (int k = 0; k < count; ++k) x.push_back(from + (to - from) * k / (count - 1));
  return x;
}

template <class F>
std::vector<double> map(const std::vector<double>& x, F f) {
  std::vector<double> y;
  for (double value : x) y.push_back(f(value));
  return y;
}

TEST_CASE("a straight line gives back its parameters") {
  const auto x = grid(-3e-3, 5e-3, 41);
  const LineFit fit = fit_line(x, map(x, [](double t) { return 1500.0 - 6e5 * t; }));
  CHECK(fit.offset == Approx(1500.0).epsilon(1e-12));
  CHECK(fit.slope == Approx(-6e5).epsilon(1e-12));
  CHECK(fit.r2 == Approx(1.0).epsilon(1e-12));
  CHECK(fit.slope_error == Approx(0.0).margin(1e-6));
  CHECK(fit.samples == 41);
}

TEST_CASE("a line through scattered points: worked by hand") {
  // means 1.5 and 2; Sxx = 5, Sxy = 3, slope 0.6; residuals -0.1, 0.3, -0.3, 0.1 (squares 0.2),
  // total 2
  const std::vector<double> x{0, 1, 2, 3}, y{1, 2, 2, 3};
  const LineFit fit = fit_line(x, y);
  CHECK(fit.slope == Approx(0.6));
  CHECK(fit.offset == Approx(1.1));
  CHECK(fit.r2 == Approx(1.0 - 0.2 / 2.0));
  CHECK(fit.slope_error == Approx(std::sqrt(0.2 / 2.0 / 5.0)));
}

TEST_CASE("an exponential gives back its parameters, rising, falling, flat, far from the origin") {
  const double rate = GENERATE(100.0, -40.0, 0.0, 3000.0), origin = GENERATE(0.0, -6e-3, 2e-2);
  const auto x = grid(origin, origin + 2e-3, 200);
  const ExponentialFit fit =
      fit_exponential(x, map(x, [&](double t) { return 500.0 * std::exp(rate * (t - origin)); }));
  // rate is found to within the golden section's last interval, about 1e-8 of 1/range
  CHECK(fit.rate == Approx(rate).epsilon(1e-6).margin(1e-3));
  CHECK(fit.at(origin) == Approx(500.0).epsilon(1e-6));
  if (rate != 0.0) CHECK(fit.r2 == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("an exponential through noise is the least-squares one: no neighbour is better") {
  Random random(3);
  const auto x = grid(0.0, 2e-3, 150);
  const auto y = map(
      x, [&](double t) { return 500.0 * std::exp(300.0 * t) + 80.0 * random.uniform(-1.0, 1.0); });
  const ExponentialFit fit = fit_exponential(x, y);
  const auto squares = [&](double amplitude, double rate) {
    double sum = 0.0;
    for (size_t k = 0; k < x.size(); ++k)
      sum += std::pow(y[k] - amplitude * std::exp(rate * x[k]), 2);
    return sum;
  };
  const double least = squares(fit.amplitude, fit.rate);
  for (double a : {-1e-3, 0.0, 1e-3})
    for (double r : {-1e-3, 0.0, 1e-3})
      if (a != 0.0 || r != 0.0) CHECK(squares(fit.amplitude * (1 + a), fit.rate * (1 + r)) > least);
  CHECK(fit.rate == Approx(300.0).epsilon(0.1));
  CHECK(fit.r2 > 0.6);
  CHECK(fit.r2 < 1.0);
}

TEST_CASE("fits pass over samples that are not finite, and know nothing of too few") {
  const std::vector<double> x{0, 1, not_known, 2, 3}, y{1, 3, 100, INFINITY, 7};
  const LineFit fit = fit_line(x, y);
  CHECK(fit.samples == 3);
  CHECK(fit.slope == Approx(2.0));
  const std::vector<double> one{1.0}, same{1.0, 1.0}, values{2.0, 3.0}, none;
  CHECK(std::isnan(fit_line(one, one).slope));
  CHECK(std::isnan(fit_line(same, values).slope));
  CHECK(std::isnan(fit_exponential(same, values).rate));
  CHECK(std::isnan(fit_exponential(none, none).r2));
  CHECK(std::isnan(fit_line(values, same).r2));  // constant y: nothing to explain
  CHECK_THROWS_AS(fit_line(one, values), std::invalid_argument);
}

TEST_CASE("the low-pass keeps lines, kills what is faster than its window, shifts nothing") {
  const auto x = grid(0.0, 1.0, 201);
  const auto line = map(x, [](double t) { return 3.0 - 2.0 * t; });
  const auto smooth_line = low_pass(line, 21);
  for (size_t k = 20; k + 20 < line.size(); ++k)
    CHECK(smooth_line[k] == Approx(line[k]).epsilon(1e-12));

  std::vector<double> alternating(201), bump(201, 0.0);
  for (size_t k = 0; k < alternating.size(); ++k) alternating[k] = k % 2 ? 1.0 : -1.0;
  const auto calm = low_pass(alternating, 21);
  for (size_t k = 20; k + 20 < calm.size(); ++k) CHECK(std::abs(calm[k]) < 1e-2);

  bump[100] = 1.0;
  const auto spread = low_pass(bump, 21);
  for (size_t k = 0; k <= 10; ++k) CHECK(spread[100 - k] == Approx(spread[100 + k]));
  CHECK(spread[100] > spread[101]);
  CHECK(spread[111] == 0.0);
  double sum = 0.0;
  for (double value : spread) sum += value;
  CHECK(sum == Approx(1.0));
}

TEST_CASE("the low-pass leaves gaps where they are") {
  std::vector<double> y(50, 4.0);
  y[20] = not_known;
  const auto smooth = low_pass(y, 9);
  CHECK(std::isnan(smooth[20]));
  for (size_t k : {0, 19, 21, 49}) CHECK(smooth[k] == Approx(4.0));
  CHECK(low_pass(std::vector<double>{1.0, 5.0}, 1) == std::vector<double>{1.0, 5.0});
}

TEST_CASE("statistics and quantiles") {
  const std::vector<double> values{4.0, not_known, 1.0, 3.0, 2.0};
  const Statistics s = statistics(values);
  CHECK(s.mean == Approx(2.5));
  CHECK(s.min == 1.0);
  CHECK(s.max == 4.0);
  CHECK(s.samples == 4);
  CHECK(quantile(values, 0.5) == 2.5);
  CHECK(quantile(values, 0.95) == Approx(3.85));
  CHECK(quantile(values, 0.0) == 1.0);
  CHECK(quantile(values, 1.0) == 4.0);
  CHECK(std::isnan(statistics({}).mean));
  CHECK(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace ballast
