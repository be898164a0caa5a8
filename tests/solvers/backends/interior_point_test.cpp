#include "solvers/backends/interior_point.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

TEST_CASE(
    "the interior point alone solves frictionless problems in few factorisations, in both forms",
    "[factors]") {
  for (const std::uint64_t seed : {1, 2, 3}) {
    FrictionProblem problem =
        make_known_solution({.bodies = 40, .contacts = 60, .friction_max = 0.0, .seed = seed})
            .problem;
    for (const bool stored : {false, true}) {
      if (stored) add_delassus_form(problem);
      problem.has_dynamics = !stored;
      const SolverRun run = SolverRunner().run(*make_interior_point(/*polish_from=*/0.0), problem,
                                               {}, {.tolerance = 1e-9});
      CAPTURE(seed, stored, name_of(run.solved.reason), run.error.natural_map_rms);
      CHECK(run.is_solved());
      CHECK(run.solved.iterations < 40);
    }
  }
}

TEST_CASE("the interior point alone comes near Coulomb's law, and with Newton all the way",
          "[factors]") {
  const FrictionProblem problem = make_known_solution({.bodies = 30, .contacts = 60}).problem;
  const double scale = contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
  const SolverRun near = SolverRunner().run(*make_interior_point(/*polish_from=*/0.0), problem, {},
                                            {.tolerance = 1e-4 * scale, .max_iterations = 300});
  CHECK(near.is_solved());
  const Budget whole{.tolerance = 1e-10, .max_iterations = 300, .keep_history = true};
  const SolverRun run = SolverRunner().run(*make_interior_point(), problem, {}, whole);
  CHECK(run.is_solved());
  CHECK(run.solved.history.back().iteration == run.solved.iterations);
}
