// Weighted least squares on laws and errors that are known.

#include "experiments/measure/weighted_fit.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Columns 1, x, x^2 ... for x = 0 ... points - 1.
Eigen::MatrixXd powers(int points, int values) {
  Eigen::MatrixXd design(points, values);
  for (int k = 0; k < points; ++k)
    for (int power = 0; power < values; ++power) design(k, power) = std::pow(k, power);
  return design;
}

}  // namespace

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
