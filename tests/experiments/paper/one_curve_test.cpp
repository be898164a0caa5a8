// One curve through all that is varied, on laws that are known.

#include "experiments/paper/one_curve.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

constexpr double scatter = 0.05;  // of ln Delta x_max between samples

struct Law {
  double prefactor, exponent, bend;  ///< of ln Delta x_max in ln X: offset, slope, half curvature
  double extra_force = 0.0;          ///< a further exponent of f_max: no grouping
};

/// Three samples of one setting; the packings have offsets of their own.
VariedValue value_of(double value, double nu, double force, double g, double wall, const Law& law,
                     Random& random) {
  VariedValue result{value, "", 3, {}, {1, 2, 3}, {}};
  for (int seed = 1; seed <= 3; ++seed) {
    Observation seen;
    seen.facts.frequency = nu;
    seen.facts.grain_mass = 100.0;
    seen.facts.wall_mass = wall * 100.0;
    seen.facts.gravity = g;
    seen.facts.f_max = force * 100.0 * 9.81;
    const double u = std::log(seen.eq3() / 0.03);
    seen.rise = 0.03 * std::exp(law.prefactor + law.exponent * u + law.bend * u * u +
                                law.extra_force * std::log(force / 3.0) + 0.1 * (seed - 2) +
                                scatter * random.uniform(-1.7, 1.7));
    result.samples.push_back(seen);
  }
  return result;
}

OneCurve curve_of_law(const Law& law) {
  Random random(7);
  std::vector<std::vector<VariedValue>> values(4);
  for (const double nu : {1.0, 2.0, 5.0, 10.0, 20.0, 60.0})
    values[0].push_back(value_of(nu, nu, 3.0, 9.81, 0.5, law, random));
  for (const double force : {1.5, 2.0, 3.0, 5.0, 8.0})
    values[1].push_back(value_of(force, 10.0, force, 9.81, 0.5, law, random));
  for (const double g : {2.4525, 4.905, 9.81, 14.715})
    values[2].push_back(value_of(g, 10.0, 3.0, g, 0.5, law, random));
  for (const double wall : {0.1, 0.5, 1.0, 2.0})
    values[3].push_back(value_of(wall, 10.0, 3.0, 9.81, wall, law, random));
  return one_curve(values);
}

}  // namespace

TEST_CASE("a curve that bends is one curve, no line, and its base counts once") {
  const OneCurve all = curve_of_law({-3.6, 0.85, -0.03});
  CHECK(all.points.size() == 6 + 4 + 3 + 3);
  CHECK(all.curve.fit.value[2] == Approx(-0.03).margin(0.01));
  CHECK(all.curve_misfit.p > 0.05);
  CHECK(all.bend.p < 1e-3);
  CHECK(all.third.p > 0.01);
  CHECK(all.offsets.p > 0.01);
  CHECK(all.curvature.mean == Approx(-0.03).margin(0.01));
  CHECK(all.line_misfit.reduced > all.curve_misfit.reduced);
  // packings differ by 10 %, which is not in the scatter from run to run
  CHECK(all.between.deviation > 0.08);
  CHECK(all.paired.deviation == Approx(scatter).epsilon(0.35));
  CHECK(all.paired.degrees_of_freedom == 15 * 2);
}

TEST_CASE("each series' exponent is predicted from the others") {
  const OneCurve all = curve_of_law({-3.6, 0.85, 0.0});
  REQUIRE(all.exponents.size() == 4);
  for (const SeriesExponent& seen : all.exponents) {
    const double expected = 0.85 * all_series()[seen.series].exponent;
    CHECK(seen.own == Approx(expected).margin(4.0 * seen.own_error));
    CHECK(seen.predicted == Approx(expected).margin(4.0 * seen.predicted_error));
    CHECK(seen.is_inside == (seen.series != 0));  // nu alone reaches so far
  }
}

TEST_CASE("a law that Eq. 3 does not group is seen") {
  const OneCurve all = curve_of_law({-3.6, 0.85, 0.0, 0.8});
  CHECK(all.exponents[1].p < 1e-3);
  CHECK(all.curve_misfit.p < 1e-3);
}

TEST_CASE("a constant force's prefactor gives the force back") {
  // C = (9/4 pi^2) (F/m g)^2 with F = m g
  CHECK(force_of_prefactor(9.0 / (4.0 * std::acos(-1.0) * std::acos(-1.0))) == Approx(1.0));
}
