// One solve to a tolerance in either measure: what backends are asked for in each round.

#include "experiments/compare/drive_solver.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Another backend, with a note of every budget that it was given.
class Noting final : public Solver {
 public:
  explicit Noting(const char* name) : solver_(make_solver(name)) {}
  void prepare(const FrictionProblem& problem) override {
    ++prepared;
    solver_->prepare(problem);
  }
  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    budgets.push_back(budget);
    return solver_->solve(problem, std::move(start), budget);
  }
  std::vector<Budget> budgets;
  int prepared = 0;

 private:
  std::unique_ptr<Solver> solver_;
};

/// Says that it is there, and gives back its start.
class Liar final : public Solver {
 public:
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem&, Impulses start, const Budget& budget) override {
    asked.push_back(budget.tolerance);
    Solved solved;
    solved.impulses = std::move(start);
    solved.reason = StopReason::reached_tolerance;
    return solved;
  }
  std::vector<double> asked;
};

FrictionProblem heavy_problem() {
  KnownSolutionSettings settings;
  settings.bodies = 10;
  settings.contacts = 20;
  settings.seed = 2;
  settings.mass_ratio = 100.0;
  return make_known_solution(settings).problem;
}

}  // namespace

TEST_CASE("The natural map needs one round, in units of the velocity scale") {
  const FrictionProblem problem = heavy_problem();
  Noting solver("pgs");
  DriveSettings settings;
  settings.tolerance = 1e-3;
  settings.velocity_scale = 5.0;
  settings.max_iterations = 100000;
  const DrivenSolve driven = drive_solver(solver, problem, {}, settings);
  REQUIRE(solver.budgets.size() == 1);
  CHECK(solver.budgets[0].tolerance == 1e-3 * 5.0);
  CHECK(solver.budgets[0].max_iterations == 100000);
  CHECK(solver.budgets[0].max_seconds <= 60.0);
  CHECK(driven.claimed);
  CHECK(driven.rounds == 1);
  CHECK(driven.last.error.natural_map_rms <= 1e-3 * 5.0);
  CHECK(driven.seconds() == driven.prepare_seconds + driven.solve_seconds);
  REQUIRE_FALSE(driven.history.empty());
  CHECK(driven.history.back().error == Approx(driven.last.error.natural_map_rms / 5.0));
}

TEST_CASE("The measure of Siconos is reached through falling tolerances on the natural map") {
  const FrictionProblem problem = heavy_problem();
  for (const char* name : {"pgs", "nncg"}) {
    INFO(name);
    Noting solver(name);
    DriveSettings settings;
    settings.measure = Measure::fclib;
    settings.tolerance = 1e-7;
    const DrivenSolve driven = drive_solver(solver, problem, {}, settings);
    CHECK(driven.claimed);
    CHECK(driven.last.error.fclib <= 1e-7);
    CHECK(driven.rounds > 1);  // 1e-7 is more than one fall of 1e-3
    CHECK(solver.prepared == 1);
    REQUIRE(static_cast<int>(solver.budgets.size()) == driven.rounds);
    for (size_t k = 1; k < solver.budgets.size(); ++k) {
      CHECK(solver.budgets[k].tolerance <= 0.5 * solver.budgets[k - 1].tolerance);
      CHECK(solver.budgets[k].max_seconds < solver.budgets[k - 1].max_seconds);
    }
    for (size_t k = 1; k < driven.history.size(); ++k) {
      CHECK(driven.history[k].round >= driven.history[k - 1].round);
      CHECK(driven.history[k].seconds >= driven.history[k - 1].seconds);
      CHECK(driven.history[k].iteration >= driven.history[k - 1].iteration);
    }
    CHECK(driven.history.back().round == driven.rounds - 1);
    CHECK(driven.history.back().iteration == driven.iterations);
  }
}

TEST_CASE("A backend that only says so is asked for less and less, and then left") {
  Liar solver;
  DriveSettings settings;
  settings.measure = Measure::fclib;
  settings.tolerance = 1e-6;
  const DrivenSolve driven = drive_solver(solver, heavy_problem(), {}, settings);
  CHECK_FALSE(driven.claimed);
  CHECK(driven.rounds == 60);
  for (size_t k = 1; k < solver.asked.size(); ++k)
    CHECK(solver.asked[k] <= 0.5 * solver.asked[k - 1]);
}

TEST_CASE("A backend that gives up ends the rounds") {
  Noting solver("pgs");
  DriveSettings settings;
  settings.measure = Measure::fclib;
  settings.tolerance = 1e-9;
  settings.max_iterations = 2;
  const DrivenSolve driven = drive_solver(solver, heavy_problem(), {}, settings);
  CHECK_FALSE(driven.claimed);
  CHECK(driven.rounds == 1);
  CHECK(driven.iterations == 2);
  CHECK(driven.last.solved.reason == StopReason::iteration_limit);
}
