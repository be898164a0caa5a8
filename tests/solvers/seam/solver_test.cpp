#include "solvers/seam/solver.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("reasons, verdicts and laws have the names that records keep") {
  CHECK(std::string(name_of(StopReason::reached_tolerance)) == "reached_tolerance");
  CHECK(std::string(name_of(StopReason::numerical_failure)) == "numerical_failure");
  CHECK(std::string(name_of(Verdict::solved)) == "solved");
  CHECK(std::string(name_of(Verdict::unreadable)) == "unreadable");
  CHECK(std::string(name_of(ContactLaw::coulomb)) == "coulomb");
  CHECK(std::string(name_of(ContactLaw::convex_relaxation)) == "convex_relaxation");
}

TEST_CASE("what is left of a budget is never less than nothing, and the rest of it stays") {
  const Budget whole{
      .tolerance = 1e-3, .max_iterations = 10, .max_seconds = 2.0, .keep_history = true};
  const Budget rest = whole.after(4, 0.5);
  CHECK(rest.max_iterations == 6);
  CHECK(rest.max_seconds == 1.5);
  CHECK(rest.tolerance == 1e-3);
  CHECK(rest.keep_history);
  CHECK(whole.after(11, 3.0).max_iterations == 0);
  CHECK(whole.after(11, 3.0).max_seconds == 0.0);
}

TEST_CASE("the history of two solves booked as one holds no iteration twice") {
  Solved solved, next;
  solved.history = {{0, 0.0, 1.0}};
  next.history = {{0, 0.0, 1.0}, {4, 0.5, 0.1}};
  next.iterations = 4;
  solved.go_on(next, 1.0);
  REQUIRE(solved.history.size() == 2);
  CHECK(solved.history[0].seconds == 1.0);
  CHECK(solved.history[1].iteration == 4);
  solved.go_on(next, 2.0);
  CHECK(solved.history.size() == 3);
}

// Siconos' measure as a reason to stop: the judge's number, evaluated when it may matter.

TEST_CASE("it is reached where the judge says so, and aims at the natural map of that place") {
  const KnownSolution known = make_known_solution({});
  FclibStop stop(known.problem, 1e-4);
  Budget budget{.tolerance = 3e-5};
  CHECK(budget.aim() == 3e-5);  // without Siconos' measure
  budget.fclib = &stop;
  CHECK(budget.aim() > 1e300);
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
  // The solution itself, with a natural map that is hardly better than before, is not evaluated.
  CHECK_FALSE(stop.reached(known.r, 0.9 * error));
  CHECK(stop.reached(known.r, 0.4 * error));
}
