#include "solvers/parts/newton_step.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

KnownSolution regular() { return make_known_solution({.bodies = 40, .contacts = 30}); }

}  // namespace

TEST_CASE("every equation's residual is zero at the solution, and its iterate stays there",
          "[factors]") {
  const KnownSolution known = regular();
  NewtonStep step;
  step.prepare(known.problem);
  for (const ContactEquation equation :
       {ContactEquation::natural_map, ContactEquation::alart_curnier}) {
    step.begin(equation, 1.0, known.r);
    step.set_proximal(1e-3);
    CHECK(step.residual() <= 1e-12);
    CHECK(step.error() <= 1e-12);
    step.newton(8);
    CHECK((step.impulses() - known.r).norm() <= 1e-8 * known.r.norm());
  }
}

TEST_CASE("Newton steps near the solution are quadratic, and the error is the judge's",
          "[factors]") {
  const KnownSolution known = regular();
  NewtonStep step;
  step.prepare(known.problem);
  step.begin(ContactEquation::alart_curnier, 1.0, 1.001 * known.r);
  step.set_proximal(1e-5);
  CHECK(step.error() == Approx(contact_error(known.problem, 1.001 * known.r).natural_map_rms));
  const double begin = step.residual();
  for (int k = 0; k < 2; ++k) {  // 4e-3, 4e-7, then rounding / alpha
    CHECK(step.newton(8));
    step.centre();
  }
  CHECK(step.residual() <= 1e-7 * begin);
  CHECK(step.error() <= 1e-9);
}

TEST_CASE("a proximal term pulls towards the centre", "[factors]") {
  const KnownSolution known = regular();
  NewtonStep step;
  step.prepare(known.problem);
  const auto moved = [&](double weight) {
    step.begin(ContactEquation::natural_map, 1.0, 1.001 * known.r);
    step.set_proximal(weight);
    for (int k = 0; k < 10; ++k) step.newton(8);
    return (step.impulses() - 1.001 * known.r).norm();
  };
  const double free = moved(1e-7), held = moved(1e3);
  CHECK(free == Approx((0.001 * known.r).norm()).epsilon(0.5));
  CHECK(held < 0.1 * free);
  CHECK(held > 0.0);
}

TEST_CASE("restart goes where it is told; what nothing moves loses its impulse", "[factors]") {
  const FrictionProblem problem = oracle::mixed_problem();  // contact 4: nothing moves
  NewtonStep step;
  step.prepare(problem);
  const Impulses r = Impulses::Constant(problem.row_count(), 0.3);
  step.begin(ContactEquation::natural_map, 1.0, r);
  Impulses expected = r;
  expected.segment(problem.row_begin[4], 3).setZero();
  CHECK(step.impulses() == expected);
  const double begin = step.residual();
  step.restart(2.0 * expected);
  CHECK(step.impulses() == 2.0 * expected);
  CHECK(step.residual() != begin);
  step.restart(expected);
  CHECK(step.residual() == begin);
}
