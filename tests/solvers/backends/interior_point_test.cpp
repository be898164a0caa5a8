#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

TEST_CASE("the interior point solves in few factorisations, in both forms", "[factors]") {
  for (const double friction : {0.0, 0.5})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const FrictionProblem dynamics =
          make_known_solution(
              {.bodies = 40, .contacts = 60, .friction_max = friction, .seed = seed})
              .problem;
      for (const FrictionProblem& problem : {dynamics, only_delassus(dynamics)}) {
        const Budget budget{.tolerance = 1e-9, .keep_history = true};
        const SolverRun run = judged_by(make_interior_point(), problem, budget);
        CAPTURE(friction, seed, name_of(run.solved.reason), run.error.natural_map_rms);
        CHECK(run.is_solved());
        CHECK(run.solved.iterations < (friction > 0.0 ? 150 : 40));
        CHECK(run.solved.history.back().iteration == run.solved.iterations);
      }
    }
}
