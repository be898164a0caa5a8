// The one curve through all variations, on known laws.

#include "experiments/paper/laws.hpp"

#include <cmath>

#include "platform/random.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

constexpr double scatter = 0.05;  // standard deviation of ln Delta x_max between samples

struct Law {
  double prefactor, exponent, bend;  ///< of ln Delta x_max in ln X: offset, slope, half curvature
  double extra_force = 0.0;          ///< added to the exponent of f_max, which breaks the grouping
  double other_gravity = 0.0;        ///< added to ln Delta x_max where g is not the Earth's
};

/// Three samples of one setting. Each packing has an offset of its own.
Group group_of(double nu, double force, double g, double wall, const Law& law, Random& random,
               std::vector<RunRow>& rows) {
  Group group;
  for (int seed = 1; seed <= 3; ++seed) {
    RunSummary run;
    RunFacts& facts = run.facts;
    facts.seed = seed;
    facts.frequency = nu;
    facts.grain_mass = 100.0;
    facts.wall_mass = wall * 100.0;
    facts.gravity = g;
    facts.f_max = force * 100.0 * 9.81;
    const double u = std::log(eq3_displacement(facts) / 0.03);
    run.rise.mean = 0.03 * std::exp(law.prefactor + law.exponent * u + law.bend * u * u +
                                    law.extra_force * std::log(force / 3.0) +
                                    (g == 9.81 ? 0.0 : law.other_gravity) + 0.1 * (seed - 2) +
                                    scatter * random.uniform(-1.7, 1.7));
    RunRow& row = rows.emplace_back(run);
    group.samples.push_back(&row);
  }
  return group;
}

MasterCurve curve_of_law(const Law& law) {
  Random random(7);
  static std::vector<RunRow> rows;  // the rows that the curve's points refer to
  rows.clear();
  rows.reserve(60);
  std::vector<Groups> groups(4);
  for (const double nu : {1.0, 2.0, 5.0, 10.0, 20.0, 60.0})
    groups[0].push_back(group_of(nu, 3.0, 9.81, 0.5, law, random, rows));
  for (const double force : {1.5, 2.0, 3.0, 5.0, 8.0})
    groups[1].push_back(group_of(10.0, force, 9.81, 0.5, law, random, rows));
  for (const double g : {2.4525, 4.905, 9.81, 14.715})
    groups[2].push_back(group_of(10.0, 3.0, g, 0.5, law, random, rows));
  for (const double wall : {0.1, 0.5, 1.0, 2.0})
    groups[3].push_back(group_of(10.0, 3.0, 9.81, wall, law, random, rows));
  return fit_master_curve(groups);
}

}  // namespace

TEST_CASE("a curve that bends is one curve, no line, and its base counts once") {
  const MasterCurve all = curve_of_law({-3.6, 0.85, -0.03});
  CHECK(all.points.size() == 6 + 4 + 3 + 3);
  CHECK(all.curve.fit.value[2] == Approx(-0.03).margin(0.01));
  CHECK(all.curve_misfit.p > 0.05);
  CHECK(all.bend.p < 1e-3);
  CHECK(all.third.p > 0.01);
  CHECK(all.offsets.p > 0.01);
  CHECK(all.line_misfit.ratio > all.curve_misfit.ratio);
  // Packings differ by 10 %, which does not enter the scatter from run to run.
  CHECK(all.between.deviation > 0.08);
  CHECK(all.paired.deviation == Approx(scatter).epsilon(0.35));
  CHECK(all.paired.degrees_of_freedom == 15 * 2);
}

TEST_CASE("a law that Eq. 3 does not group is seen") {
  // An exponent of f_max that is not Eq. 3's turns its series about the base and is no offset.
  CHECK(curve_of_law({-3.6, 0.85, 0.0, 0.8}).curve_misfit.p < 1e-3);
  const MasterCurve shifted = curve_of_law({-3.6, 0.85, 0.0, 0.0, 0.4});
  CHECK(shifted.offsets.p < 1e-3);
  CHECK(shifted.largest_offset == Approx(0.4).margin(4.0 * shifted.offset_error));
  CHECK(shifted.curve_misfit.p < 1e-3);
}
