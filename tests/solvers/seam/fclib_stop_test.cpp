// Siconos' measure as a reason to stop: the judge's number, looked at when it may matter.

#include "solvers/seam/fclib_stop.hpp"

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/solver.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

Impulses random_impulses(int rows, std::uint64_t seed) {
  ProblemRandom random(seed);
  Impulses r(rows);
  for (double& x : r) x = random.uniform(-1.0, 2.0);
  return r;
}

}  // namespace

TEST_CASE("the measure is the judge's, for both forms and for one-row contacts") {
  KnownSolutionSettings settings;
  settings.frictionless_fraction = 0.3;
  settings.mass_ratio = 1e3;
  FrictionProblem problem = make_known_solution(settings).problem;
  for (const bool is_stored : {false, true}) {
    if (is_stored) {
      add_delassus_form(problem);
      problem.has_dynamics = false;
    }
    FclibStop stop(problem, 1e-4);
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      const Impulses r = random_impulses(problem.row_count(), seed);
      CHECK(stop.measure(r) == Approx(contact_error(problem, r).fclib).epsilon(1e-12));
    }
  }
}

TEST_CASE("it is reached where the judge says so, and aims at the natural map of that place") {
  const KnownSolution known = make_known_solution({});
  FclibStop stop(known.problem, 1e-4);
  CHECK(stop.aim() > 1e300);
  const Impulses near = known.r * (1.0 + 1e-7), far = known.r * 1.5;
  const ContactError at_far = contact_error(known.problem, far);
  CHECK_FALSE(stop.reached(far, at_far.natural_map_rms));
  CHECK(stop.aim() == Approx(at_far.natural_map_rms * 1e-4 / at_far.fclib));
  CHECK(stop.reached(near, contact_error(known.problem, near).natural_map_rms));
  CHECK_FALSE(stop.reached(near, std::numeric_limits<double>::quiet_NaN()));
}

TEST_CASE("after the first looks it looks again only where the natural map has halved or is near") {
  const KnownSolution known = make_known_solution({});
  FclibStop stop(known.problem, 1e-4);
  const Impulses far = known.r * 1.5;
  const double error = contact_error(known.problem, far).natural_map_rms;
  for (int k = 0; k < 4; ++k) CHECK_FALSE(stop.reached(far, error));
  // the solution itself, called no better than before, is not looked at
  CHECK_FALSE(stop.reached(known.r, 0.9 * error));
  CHECK(stop.reached(known.r, 0.4 * error));
}

TEST_CASE("a budget without it aims at its tolerance") {
  const KnownSolution known = make_known_solution({});
  FclibStop stop(known.problem, 1e-4);
  Budget budget{.tolerance = 3e-5};
  CHECK(budget.aim() == 3e-5);
  budget.fclib = &stop;
  CHECK(budget.aim() > 1e300);
}
