#include "problems/algebra/known_masses.hpp"

#include <limits>

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("known masses are not looked at again, others and all the rest are") {
  KnownSolutionSettings settings;
  settings.contacts = 20;
  const FrictionProblem good = make_known_solution(settings).problem;
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  KnownMasses valid;
  CHECK_FALSE(valid.are_of(good.dynamics));
  validate(good, valid);
  REQUIRE(valid.are_of(good.dynamics));
  validate(good, valid);

  // One mass changes by its last bit, or is no mass any more.
  FrictionProblem other = good;
  double& mass = other.dynamics.mass[0];
  mass = std::nextafter(mass, 2.0 * mass);
  CHECK_FALSE(valid.are_of(other.dynamics));
  mass = -1.0;
  CHECK_THROWS_AS(validate(other, valid), InvalidProblem);
  CHECK(valid.are_of(good.dynamics));

  // With the masses known, every other entry is still looked at.
  other = good;
  other.dynamics.h.back() = not_a_number;
  CHECK_THROWS_AS(validate(other, valid), InvalidProblem);
  other = good;
  other.dynamics.v_free[1] = not_a_number;
  CHECK_THROWS_AS(validate(other, valid), InvalidProblem);
  other = good;
  other.friction[0] = -0.5;
  CHECK_THROWS_AS(validate(other, valid), InvalidProblem);

  // Another number of unknowns, of bodies: not the same masses.
  other = good;
  other.dynamics.dof_begin.back() += 1;
  CHECK_FALSE(valid.are_of(other.dynamics));
  CHECK_THROWS_AS(validate(other, valid), InvalidProblem);
}
