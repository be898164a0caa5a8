// Requirements of every registered backend: limits of size, iterations and time; repeatability;
// history.

#include <limits>

#include "tests/solvers/conformance_support.hpp"

using namespace ballast;

/// A backend takes every problem up to its stated limit, and takes no larger one.
TEST_CASE("a backend takes problems up to the size that the register says") {
  for_each_backend([](const SolverEntry& entry) {
    const auto is_taken = [&](int contacts) {
      const FrictionProblem problem = make_known_solution({.bodies = contacts,
                                                           .contacts = contacts,
                                                           .friction_min = 0.1,
                                                           .frictionless_fraction = 0.0})
                                          .problem;
      return run_unless_large(entry, problem, {.max_iterations = 0}).has_value();
    };
    CHECK(is_taken(entry.largest == 0 ? 2000 : entry.largest));
    if (entry.largest > 0) CHECK_FALSE(is_taken(entry.largest + 1));
  });
}

TEST_CASE("limits of iterations and of time are kept") {
  for_each_backend([](const SolverEntry& entry) {
    const int contacts = contacts_for(entry, 600);
    const FrictionProblem problem = known(std::max(2, contacts / 3), contacts, 0.8, 1e4).problem;
    for (const int limit : {0, 1, 3}) {
      Budget budget{.tolerance = 0.0, .max_iterations = limit};
      const SolverRun result = run_either(entry, problem, budget);
      CHECK(result.solved.iterations <= limit);
      CHECK(result.error.finite);
    }
    Budget budget{
        .tolerance = 0.0, .max_iterations = std::numeric_limits<int>::max(), .max_seconds = 0.05};
    const SolverRun result = run_either(entry, problem, budget);
    CHECK(result.solve_seconds < 2.0);
    CHECK(result.solved.reason != StopReason::iteration_limit);
  });
}

TEST_CASE("a start from the solution stops at once") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem =
        known(50, contacts_for(entry, 40), solves_coulomb(entry) ? 0.5 : 0.0, 1.0).problem;
    const SolverRun cold = run_either(entry, problem, patient);
    REQUIRE(cold.is_solved());
    const SolverRun warm = run_either(entry, problem, patient, cold.solved.impulses);
    CHECK(warm.is_solved());
    CHECK(warm.solved.iterations <= 1);
  });
}

TEST_CASE("both forms of a problem give the same answer") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(50, contacts_for(entry, 40), 0.5, 1.0).problem;
    const Budget budget{.tolerance = 1e-10, .max_iterations = 100000, .max_seconds = 20.0};
    const auto dynamics = run(entry, problem, budget),
               delassus = run(entry, only_delassus(problem), budget);
    REQUIRE((dynamics || delassus));
    if (!dynamics || !delassus) return;
    Eigen::VectorXd u, w;
    contact_velocity(problem, dynamics->solved.impulses, u);
    contact_velocity(problem, delassus->solved.impulses, w);
    CHECK((u - w).norm() < 1e-7 * u.norm());
  });
}

TEST_CASE("the same problem gives the same bits") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(30, contacts_for(entry, 60), 0.5, 10.0).problem;
    const Budget budget{.tolerance = 1e-6, .max_iterations = 200};
    const SolverRun once = run_either(entry, problem, budget),
                    again = run_either(entry, problem, budget);
    CHECK(once.solved.impulses == again.solved.impulses);
  });
}

TEST_CASE("history is kept on request, and ends with what is returned") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem =
        known(50, contacts_for(entry, 40), solves_coulomb(entry) ? 0.5 : 0.0, 1.0).problem;
    Budget budget = patient;
    const SolverRun silent = run_either(entry, problem, budget);
    CHECK(silent.solved.history.empty());
    budget.keep_history = true;
    const SolverRun result = run_either(entry, problem, budget);
    REQUIRE_FALSE(result.solved.history.empty());
    CHECK(result.solved.history.back().iteration == result.solved.iterations);
    CHECK(result.solved.history.back().error ==
          Approx(result.error.natural_map_rms).epsilon(1e-3).margin(1e-14));
    for (std::size_t i = 1; i < result.solved.history.size(); ++i) {
      CHECK(result.solved.history[i].iteration > result.solved.history[i - 1].iteration);
      CHECK(result.solved.history[i].seconds >= result.solved.history[i - 1].seconds);
    }
  });
}
