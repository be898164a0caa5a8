#include "solvers/parts/regular_newton.hpp"

#include <algorithm>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

KnownSolution some_solution(int bodies, int contacts) {
  KnownSolutionSettings settings;
  settings.bodies = bodies;
  settings.contacts = contacts;
  settings.friction_min = 0.2;
  return make_known_solution(settings);
}

}  // namespace

TEST_CASE("a step keeps impulses and bodies consistent: x is linear in r", "[factors]") {
  const KnownSolution known = some_solution(20, 60);
  RegularNewton newton;
  newton.prepare(known.problem);
  NewtonIterate at = newton.iterate(0.5 * known.r), change;
  newton.set_centre(at.r, 1e-3);
  CHECK(newton.linearise(at) == 0);
  REQUIRE(newton.step(change));
  at.r += change.r;
  at.x += change.x;
  Eigen::VectorXd x;
  newton.contacts().body_velocity(at.r, x);
  CHECK((at.x - x).norm() < 1e-9 * x.norm());
}

TEST_CASE("the residual at the centre is the judge's error", "[factors]") {
  const KnownSolution known = some_solution(20, 60);
  RegularNewton newton;
  newton.prepare(known.problem);
  NewtonIterate at = newton.iterate(0.9 * known.r);
  newton.set_centre(at.r, 1e-2);
  const double judged = contact_error(known.problem, 0.9 * known.r).natural_map_rms;
  CHECK(newton.residual(at) == Approx(judged).epsilon(1e-9));
  CHECK(newton.settle(at) == Approx(judged).epsilon(1e-9));
}

TEST_CASE("near a solution with its statuses a step squares the error, whatever W's rank",
          "[factors]") {
  for (const int contacts : {15, 80}) {  // 80: far more than the bodies can tell apart
    CAPTURE(contacts);
    const KnownSolution known = some_solution(20, contacts);
    RegularNewton newton;
    newton.prepare(known.problem);
    NewtonIterate at = newton.iterate(known.r * (1.0 + 1e-7)), change;
    double before = newton.settle(at);
    for (int k = 0; k < 3; ++k) {
      newton.set_centre(at.r, 1e-6);
      newton.linearise(at);
      REQUIRE(newton.step(change));
      at.r += change.r;
      newton.settle(at);
    }
    CHECK(before > 1e-9);
    CHECK(newton.settle(at) < 1e-12);
  }
}

TEST_CASE("statuses that change between two looks are counted", "[factors]") {
  const KnownSolution known = some_solution(20, 60);
  RegularNewton newton;
  newton.prepare(known.problem);
  const NewtonIterate solution = newton.iterate(known.r), nothing = newton.iterate(0.0 * known.r);
  newton.set_centre(solution.r, 1e-3);
  CHECK(newton.linearise(solution) == 0);
  CHECK(newton.linearise(solution) == 0);
  CHECK(newton.linearise(nothing) > 0);
  newton.set_centre(solution.r, 1e-3);
  CHECK(newton.linearise(nothing) == 0);
}
