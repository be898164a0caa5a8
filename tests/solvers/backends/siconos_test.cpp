// Siconos' own measure is used as it is, and the child process of a comparison calls Siconos
// without another process.

#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/made_problems.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

FrictionProblem small_problem() {
  return make_known_solution({.bodies = 12, .contacts = 20, .seed = 5}).problem;
}

SolverRun solved_to(const FrictionProblem& problem, SiconosMethod method, double tolerance) {
  FclibStop stop(problem, tolerance);
  Budget budget{.tolerance = 0.0, .max_seconds = 30.0};
  budget.fclib = &stop;
  return judged_by(make_siconos(method), problem, budget);
}

}  // namespace

TEST_CASE("Siconos stops on its own measure, where it was asked to") {
  if (!make_siconos(SiconosMethod::nsgs)) return;
  const FrictionProblem problem = small_problem();
  const SolverRun loose = solved_to(problem, SiconosMethod::nsgs, 1e-3);
  const SolverRun tight = solved_to(problem, SiconosMethod::nsgs, 1e-8);
  CHECK(loose.is_solved());
  CHECK(tight.is_solved());
  CHECK(loose.error.fclib <= 1e-3);
  CHECK(loose.error.fclib > 1e-6);  // not solved further than asked
  CHECK(loose.solved.iterations < tight.solved.iterations);
}

TEST_CASE("An answer that Siconos is just content with is not sent back for another round") {
  if (!make_siconos(SiconosMethod::nsgs)) return;
  // Every sweep removes 1/2000 of the error: it stops barely below the tolerance.
  const FrictionProblem problem = mass_stack({1.0, 2000.0}, 3).problem;
  const SolverRun run = solved_to(problem, SiconosMethod::nsgs_full, 1e-5),
                  further = solved_to(problem, SiconosMethod::nsgs_full, 0.9e-5);
  CHECK(run.is_solved());
  CHECK(run.solved.iterations > 100);
  CHECK(run.solved.iterations < further.solved.iterations);
}

TEST_CASE("In a child that may be lost Siconos is called as it is: the same bits") {
  if (!make_siconos(SiconosMethod::nsgs)) return;
  const FrictionProblem problem = small_problem();
  for (const SiconosMethod method : {SiconosMethod::nsgs, SiconosMethod::nsn_ac}) {
    const SolverRun here = solved_to(problem, method, 1e-6);
    const ChildResult child = run_in_child(60.0, [&] {
      Packer packer;
      packer.list(solved_to(problem, method, 1e-6).solved.impulses);
      return packer.bytes();
    });
    REQUIRE(child.end == ChildEnd::complete);
    Impulses there;
    Unpacker unpacker(child.answer, "a test's child");
    unpacker.list(there);
    unpacker.finish();
    CHECK(there == here.solved.impulses);
    CHECK(here.startup_seconds > 0.0);  // W in Siconos' form, a process, the judge
  }
}

TEST_CASE("Siconos' Newton goes on with a sparse W where it circles with a dense one") {
  if (!make_siconos(SiconosMethod::nsgs)) return;
  // 29 contacts: with a dense W a step is faster, but 200 steps do not converge. Rounding decides
  // about that: of 60 piles, this one does so with OpenBLAS for AVX-512, AVX2 and SSE3.
  const FrictionProblem problem = make_pile(random_pile(309, 60));
  FclibStop stop(problem, 1e-4);
  Budget budget{.tolerance = 0.0, .max_iterations = 4000};
  budget.fclib = &stop;
  CHECK(judged_by(make_siconos(SiconosMethod::nsn_ac), problem, budget).is_solved());
}
