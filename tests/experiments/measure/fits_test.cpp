// Fits on data whose answers are known; tests of significance against published tables and worked
// examples.

#include "experiments/measure/fits.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Twelve uniform numbers: normal enough here.
double gauss(Random& random) {
  double sum = -6.0;
  for (int k = 0; k < 12; ++k) sum += random.uniform(0.0, 1.0);
  return sum;
}

/// Columns 1, x, x^2 ... for x = 0 ... points - 1.
Eigen::MatrixXd powers(int points, int values) {
  Eigen::MatrixXd design(points, values);
  for (int k = 0; k < points; ++k)
    for (int power = 0; power < values; ++power) design(k, power) = std::pow(k, power);
  return design;
}

}  // namespace

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

TEST_CASE("sample means carry the standard error of independent samples") {
  const std::vector<double> values{1.0, 2.0, 3.0, not_known};
  const SampleMean mean = sample_mean(values);
  CHECK(mean.samples == 3);
  CHECK(mean.mean == Approx(2.0));
  CHECK(mean.error == Approx(1.0 / std::sqrt(3.0)));
  CHECK(mean.half_width() == Approx(4.303 * mean.error).epsilon(1e-3));
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
  Points points, sharp;
  for (int k = 0; k < 400; ++k) {
    const double x = 1.0 + 0.1 * k, y = 2.0 / x * (1.0 + 0.02 * gauss(random));
    points.add(x, {y, 0.02 * y, 3});
    sharp.add(x, {y, 0.005 * y, 3});
  }
  CHECK(points.errors_from == 800);
  const PowerFit fit = fit_power(points.x, points.y);
  CHECK(misfit_of(fit, points).reduced == Approx(1.0).epsilon(0.2));
  CHECK(misfit_of(fit, points).p > 0.001);
  CHECK(misfit_of(fit, sharp).reduced == Approx(16.0).epsilon(0.2));
  CHECK(misfit_of(fit, sharp).p < 1e-6);
}

TEST_CASE("chi^2 says whether points lie on a power law within their errors") {
  const auto chi2 = [&](double by, double relative) {
    Points points;
    for (int k = 0; k < 4; ++k) {
      const double y = std::pow(4.0, -k) * std::exp(k == 0 || k == 3 ? by : -by);
      points.add(std::pow(2.0, k), {y, relative * y, 3});
    }
    return misfit_of(fit_power(points.x, points.y), points).reduced;
  };
  CHECK(chi2(0.0, 0.1) == Approx(0.0).margin(1e-12));
  CHECK(chi2(0.1, 0.1) ==
        Approx(2.0));  // four residuals of one error each over two degrees of freedom
  CHECK(chi2(0.1, 0.01) == Approx(200.0));
  CHECK(std::isnan(chi2(0.0, not_known)));
}

TEST_CASE("Student's t has the p of the tables") {
  // two-sided, Abramowitz and Stegun table 26.10
  CHECK(student_p(12.706, 1) == Approx(0.05).epsilon(1e-3));
  CHECK(student_p(63.657, 1) == Approx(0.01).epsilon(1e-3));
  CHECK(student_p(4.303, 2) == Approx(0.05).epsilon(1e-3));
  CHECK(student_p(-2.228, 10) == Approx(0.05).epsilon(1e-3));
  CHECK(student_p(2.845, 20) == Approx(0.01).epsilon(1e-3));
  CHECK(student_p(0.0, 5) == Approx(1.0));
  // with one degree of freedom t is Cauchy's, with two there is a closed form
  CHECK(student_p(1.0, 1) == Approx(0.5));
  CHECK(student_p(3.0, 2) == Approx(1.0 - 3.0 / std::sqrt(11.0)));
  CHECK(std::isnan(student_p(1.0, 0)));
}

TEST_CASE("the quantile of Student's t is that of the tables") {
  CHECK(student_t95(1) == Approx(12.706).epsilon(1e-4));
  CHECK(student_t95(2) == Approx(4.303).epsilon(1e-4));
  CHECK(student_t95(30) == Approx(2.042).epsilon(3e-4));
  CHECK(student_t95(120) == Approx(1.980).epsilon(3e-4));
  CHECK(student_t95(100000) == Approx(1.960).epsilon(1e-4));
  CHECK(std::isinf(student_t95(0)));
}

TEST_CASE("F and chi squared have the p of the tables") {
  CHECK(f_p(4.26, 2, 9) == Approx(0.05).epsilon(3e-3));
  CHECK(f_p(10.04, 1, 10) == Approx(0.01).epsilon(3e-3));
  CHECK(f_p(2.98, 10, 10) == Approx(0.05).epsilon(3e-3));
  CHECK(f_p(0.0, 3, 5) == Approx(1.0));
  // chi^2 of 18.307 at 10 degrees of freedom, of 3.841 at 1
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  CHECK(f_p(18.307 / 10.0, 10, unbounded) == Approx(0.05).epsilon(1e-3));
  CHECK(f_p(3.841, 1, unbounded) == Approx(0.05).epsilon(1e-3));
  CHECK(f_p(37.566 / 20.0, 20, unbounded) == Approx(0.01).epsilon(1e-3));
  // t squared is F with one degree of freedom above
  CHECK(f_p(2.5 * 2.5, 1, 7) == Approx(student_p(2.5, 7)));
}

TEST_CASE("Holm's correction of a worked example, in the order given") {
  const std::vector<double> p{0.04, 0.01, not_known, 0.03, 0.005};
  const std::vector<double> corrected = holm(p);
  CHECK(corrected[4] == Approx(0.02));  // 4 x 0.005
  CHECK(corrected[1] == Approx(0.03));  // 3 x 0.01
  CHECK(corrected[3] == Approx(0.06));  // 2 x 0.03
  CHECK(corrected[0] == Approx(0.06));  // 0.04, but not below the one before
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
}

TEST_CASE("where nothing differs, p is below 0.05 once in twenty times") {
  Random random(11);
  int below = 0;
  constexpr int trials = 2000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> values;
    for (int k = 0; k < 3; ++k) values.push_back(gauss(random));
    if (sample_mean(values).p() < 0.05) ++below;
  }
  CHECK(below > 0.035 * trials);
  CHECK(below < 0.065 * trials);
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
  bent << 0.1, 0.9, 4.1, 8.9, 16.1, 24.9;  // x^2 with an alternating tenth
  noisy << 0.1, 0.9, 2.1, 2.9, 4.1, 4.9;   // x with it
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
