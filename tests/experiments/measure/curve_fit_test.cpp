// Fits of data with known answers; tests of significance against published tables and worked
// examples.

#include "experiments/measure/curve_fit.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

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

/// A sum of twelve uniform numbers, which is close enough to a normal one here.
double gauss(Random& random) {
  double sum = -6.0;
  for (int k = 0; k < 12; ++k) sum += random.uniform(0.0, 1.0);
  return sum;
}

/// A matrix with the columns 1, x, x^2 ... for x = 0 ... points - 1.
Eigen::MatrixXd powers(int points, int values) {
  Eigen::MatrixXd design(points, values);
  for (int k = 0; k < points; ++k)
    for (int power = 0; power < values; ++power) design(k, power) = std::pow(k, power);
  return design;
}

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// A number of a published table beside the computed one.
struct Published {
  double computed, printed, relative = 1e-3;
};

}  // namespace

TEST_CASE("a line through scattered points: worked by hand") {
  // Means 1.5 and 2; Sxx = 5, Sxy = 3, slope 0.6; residuals -0.1, 0.3, -0.3, 0.1 with the sum of
  // squares 0.2 of 2 in total.
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
  // The rate is exact to the golden section's last interval, about 1e-8 of 1/range.
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
  CHECK(std::isnan(fit_line(values, same).r2));  // y is constant: no variance to explain
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

  // Gaps stay where they are.
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

TEST_CASE("a power law's interval covers the truth as often as it says") {
  Random random(3);
  int covered = 0;
  constexpr int trials = 400;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> x, y;
    for (const double nu : {1.0, 2.0, 3.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 60.0}) {
      x.push_back(nu);
      y.push_back(0.3 * std::pow(nu, -2.0) * std::exp(0.1 * gauss(random)));
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

TEST_CASE("a proportion through the origin is the geometric mean of the ratios") {
  const std::vector<double> x{1, 10, 100}, y{0.02, 0.1, 2.0};
  const Proportion fit = fit_proportion(x, y);
  CHECK(fit.factor == Approx(0.01 * std::cbrt(4.0)));
  CHECK(fit.low < fit.factor);
  CHECK(fit.high > fit.factor);
  CHECK(fit.spread == Approx(std::exp(std::log(2.0) / std::sqrt(3.0))));
}

TEST_CASE("Eq. 5 is found again, with an interval around its corner, its gain may be given") {
  const std::vector<double> nu{1, 2, 3, 5, 7, 10, 15, 20, 30, 60};
  Random random(5);
  const double gain = 0.0025, critical = 9.0;
  const auto exact =
      map(nu, [&](double f) { return gain * (f < critical ? f : critical * critical / f); });
  const PeakedRate fit = fit_peaked_rate(
      nu, map(exact, [&](double rate) { return rate * (1.0 + random.uniform(-0.03, 0.03)); }));
  CHECK(fit.gain == Approx(gain).epsilon(0.04));
  CHECK(fit.critical == Approx(critical).epsilon(0.05));
  CHECK(fit.low < critical);
  CHECK(fit.high > critical);
  CHECK(fit.r2 > 0.98);
  CHECK(fit.at(4.5) == Approx(0.5 * fit.at(9.0)).epsilon(0.1));
  CHECK(std::isnan(fit_peaked_rate(std::vector<double>{1, 2}, std::vector<double>{1, 2}).critical));
  const PeakedRate given = fit_peaked_rate(nu, exact, gain);
  CHECK(given.gain == gain);
  CHECK(given.critical == Approx(9.0).epsilon(2e-3));
  // Twice the gain gives an earlier corner, and the curve misses the points.
  const PeakedRate wrong = fit_peaked_rate(nu, exact, 2.0 * gain);
  CHECK(wrong.gain == 2.0 * gain);
  CHECK(wrong.critical < 8.0);
  CHECK(wrong.r2 < given.r2);
  // A rate that only grows puts the corner at the end of the data.
  const PeakedRate growing = fit_peaked_rate(nu, nu);
  CHECK(growing.critical == Approx(60.0));
  CHECK(growing.gain == Approx(1.0));
}

TEST_CASE("chi^2 says whether points lie on a power law within their errors") {
  const auto misfit = [&](double by, double relative) {
    Points points;
    for (int k = 0; k < 4; ++k) {
      const double y = std::pow(4.0, -k) * std::exp(k == 0 || k == 3 ? by : -by);
      points.add(std::pow(2.0, k), {y, relative * y, 3});
    }
    CHECK(points.error_dof == 8);
    points.add(3.0, {1.0, not_known, 1});  // a point of one sample has no error and no weight
    return misfit_of(points);
  };
  CHECK(misfit(0.0, 0.1).ratio == Approx(0.0).margin(1e-12));
  // Four residuals of one error each give chi^2 = 4 over two degrees of freedom.
  CHECK(misfit(0.1, 0.1).ratio == Approx(2.0));
  CHECK(misfit(0.1, 0.1).p == Approx(f_test_p(2.0, 2, 8)));
  CHECK(misfit(0.1, 0.01).ratio == Approx(200.0));
  CHECK(misfit(0.1, 0.01).p < 1e-6);
  CHECK(std::isnan(misfit(0.0, not_known).ratio));
}

TEST_CASE("Student's t, F and chi squared have the p and the quantiles of the tables") {
  const Published table[] = {
      // Two-sided, from Abramowitz and Stegun, table 26.10.
      {t_test_p(12.706, 1), 0.05},
      {t_test_p(63.657, 1), 0.01},
      {t_test_p(4.303, 2), 0.05},
      {t_test_p(-2.228, 10), 0.05},
      {t_test_p(2.845, 20), 0.01},
      {t_test_p(0.0, 5), 1.0},
      // With one degree of freedom t is Cauchy's; with two there is a closed form.
      {t_test_p(1.0, 1), 0.5, 1e-9},
      {t_test_p(3.0, 2), 1.0 - 3.0 / std::sqrt(11.0), 1e-9},
      {student_t95(1), 12.706, 1e-4},
      {student_t95(2), 4.303, 1e-4},
      {student_t95(30), 2.042, 3e-4},
      {student_t95(120), 1.980, 3e-4},
      {student_t95(100000), 1.960, 1e-4},
      {f_test_p(4.26, 2, 9), 0.05, 3e-3},
      {f_test_p(10.04, 1, 10), 0.01, 3e-3},
      {f_test_p(2.98, 10, 10), 0.05, 3e-3},
      {f_test_p(0.0, 3, 5), 1.0},
      // chi^2 of 18.307 at 10 degrees of freedom, of 3.841 at 1.
      {f_test_p(18.307 / 10.0, 10, unbounded), 0.05},
      {f_test_p(3.841, 1, unbounded), 0.05},
      {f_test_p(37.566 / 20.0, 20, unbounded), 0.01},
      // t squared is F with one degree of freedom in the numerator.
      {f_test_p(2.5 * 2.5, 1, 7), t_test_p(2.5, 7), 1e-9}};
  for (const Published& row : table) {
    INFO(row.printed);
    CHECK(row.computed == Approx(row.printed).epsilon(row.relative));
  }
  CHECK(std::isnan(t_test_p(1.0, 0)));
  CHECK(std::isinf(student_t95(0)));
}

TEST_CASE("Holm's correction of a worked example, in the order given") {
  const std::vector<double> p{0.04, 0.01, not_known, 0.03, 0.005};
  const std::vector<double> corrected = holm(p);
  CHECK(corrected[4] == Approx(0.02));  // 4 x 0.005
  CHECK(corrected[1] == Approx(0.03));  // 3 x 0.01
  CHECK(corrected[3] == Approx(0.06));  // 2 x 0.03
  CHECK(corrected[0] == Approx(0.06));  // 0.04, but not below the previous one
  CHECK(std::isnan(corrected[2]));
  CHECK(holm(std::vector<double>{0.6, 0.7})[0] == 1.0);
}

TEST_CASE("a pooled error takes each group about its own mean") {
  const std::vector<std::vector<double>> groups{
      {1.0, 3.0}, {10.0, 11.0, 12.0}, {5.0}, {not_known, 7.0}};
  const PooledError pooled = pooled_error(groups);
  CHECK(pooled.degrees_of_freedom == 3);
  CHECK(pooled.deviation == Approx(std::sqrt((2.0 + 2.0) / 3.0)));
  CHECK(std::isnan(pooled_error(std::vector<std::vector<double>>{{1.0}}).deviation));
}

TEST_CASE("Student's own pairs: the extra hours of sleep of ten patients") {
  // Student (1908), drugs 1 and 2: t = 4.062, p = 0.002833
  const std::vector<double> a{0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0},
      b{1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  std::vector<double> more;
  for (size_t k = 0; k < a.size(); ++k) more.push_back(b[k] - a[k]);
  const SampleMean paired = sample_mean(more);
  CHECK(paired.mean == Approx(1.58));
  CHECK(paired.mean / paired.error == Approx(4.0621).epsilon(1e-4));
  CHECK(paired.p() == Approx(0.002833).epsilon(1e-3));
  CHECK(paired.half_width() == Approx(2.262 * paired.error).epsilon(1e-3));
  CHECK(std::isnan(sample_mean(std::vector<double>{1.0}).p()));
  // For two groups F is t^2.
  const VarianceRatio between = repeated_anova(std::vector{a, b});
  CHECK(between.ratio == Approx(4.0621 * 4.0621).epsilon(1e-4));
  CHECK(between.p == Approx(0.002833).epsilon(1e-3));
  CHECK(std::isnan(repeated_anova(std::vector{a, {1.0, 2.0}}).ratio));
  CHECK(std::isnan(sample_mean(std::vector<double>{}).mean));
  const SampleMean three = sample_mean(std::vector<double>{1.0, 2.0, 3.0, not_known});
  CHECK(three.samples == 3);
  CHECK(three.error == Approx(1.0 / std::sqrt(3.0)));
}

TEST_CASE("a weighted mean and its error are the textbook's") {
  const Eigen::Vector2d y(1.0, 4.0), error(1.0, 2.0);
  const WeightedFit fit = fit_weighted(powers(2, 1), y, error);
  CHECK(fit.value[0] == Approx((1.0 + 4.0 / 4.0) / 1.25));
  CHECK(fit.error_at(Eigen::VectorXd::Ones(1)) == Approx(std::sqrt(1.0 / 1.25)));
  CHECK(fit.chi2 == Approx(0.6 * 0.6 + 2.4 * 2.4 / 4.0));
  CHECK(fit.degrees_of_freedom == 1);
}

TEST_CASE("a parabola is found exactly, and its slope with it") {
  const Eigen::MatrixXd design = powers(5, 3);
  const Eigen::VectorXd y = design * Eigen::Vector3d(2.0, -1.0, 0.5);
  const WeightedFit fit = fit_weighted(design, y, Eigen::VectorXd::Ones(5));
  CHECK(fit.value[2] == Approx(0.5));
  CHECK(fit.at(Eigen::Vector3d(0.0, 1.0, 2.0 * 3.0)) == Approx(-1.0 + 3.0));
  CHECK(fit.chi2 < 1e-20);
}

TEST_CASE("a further value counts only when it mends more than chance does") {
  Eigen::VectorXd bent(6), noisy(6);
  bent << 0.1, 0.9, 4.1, 8.9, 16.1, 24.9;  // x^2 with an alternating error of 0.1
  noisy << 0.1, 0.9, 2.1, 2.9, 4.1, 4.9;   // x with this error
  const Eigen::VectorXd error = Eigen::VectorXd::Constant(6, 0.1);
  const auto p = [&](const Eigen::VectorXd& y) {
    return improvement(fit_weighted(powers(6, 2), y, error), fit_weighted(powers(6, 3), y, error))
        .p;
  };
  CHECK(p(bent) < 1e-4);
  CHECK(p(noisy) > 0.2);
  CHECK(std::isnan(
      improvement(fit_weighted(powers(6, 2), bent, error), fit_weighted(powers(6, 2), bent, error))
          .p));
}
