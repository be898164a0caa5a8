// One solve to a tolerance in either measure: every backend stops on the measure that is asked.

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
  Solved solve(const FrictionProblem&, Impulses start, const Budget&) override {
    Solved solved;
    solved.impulses = std::move(start);
    solved.reason = StopReason::reached_tolerance;
    return solved;
  }
};

FrictionProblem heavy_problem() {
  KnownSolutionSettings settings;
  settings.bodies = 10;
  settings.contacts = 20;
  settings.seed = 2;
  settings.mass_ratio = 100.0;
  return make_known_solution(settings).problem;
}

bool claims(const DrivenSolve& driven) {
  return driven.run.solved.reason == StopReason::reached_tolerance;
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
  CHECK(claims(driven));
  CHECK(driven.run.error.natural_map_rms <= 1e-3 * 5.0);
  CHECK(driven.seconds() == driven.run.prepare_seconds + driven.run.solve_seconds);
  REQUIRE_FALSE(driven.history.empty());
  CHECK(driven.history.back().error == Approx(driven.run.error.natural_map_rms / 5.0));
}

/// Methods whose error falls by little from one look to the next.
bool is_slow(const std::string& name) {
  for (const char* slow : {"pgs", "psor", "nncg", "apgd"})
    if (name == slow) return true;
  return false;
}

TEST_CASE("Every backend stops on the measure of Siconos, and not far below it") {
  for (const double mass_unit : {1.0, 1e4}) {  // W ~ 1e-4: the two measures lie far apart
    KnownSolutionSettings known;
    known.bodies = 10;
    known.contacts = 20;
    known.seed = 2;
    known.mass_ratio = 100.0;
    known.mass_unit = mass_unit;
    const FrictionProblem problem = make_known_solution(known).problem;
    DriveSettings settings;
    settings.measure = Measure::fclib;
    settings.tolerance = 1e-4;
    settings.max_seconds = 20.0;
    for (const SolverEntry& entry : solver_list()) {
      if (!entry.make || entry.law != ContactLaw::coulomb) continue;
      INFO(entry.name << ", masses of " << mass_unit << " kg");
      Noting solver(entry.name);
      DrivenSolve driven;
      try {
        driven = drive_solver(solver, problem, {}, settings);
      } catch (const UnsupportedProblem&) {
        continue;  // NLopt's dense Jacobian takes fewer contacts
      }
      CHECK(solver.prepared == 1);
      CHECK(solver.budgets.size() == 1);
      if (claims(driven)) CHECK(driven.run.error.fclib <= 1e-4);
      if (!is_slow(entry.name)) continue;
      CHECK(claims(driven));
      // Who is there at its first look, after eight sweeps, had no chance to stop before.
      if (driven.run.solved.iterations > 8) CHECK(driven.run.error.fclib > 1e-6);
    }
  }
}

TEST_CASE("A backend that only says so is not believed") {
  Liar solver;
  DriveSettings settings;
  settings.measure = Measure::fclib;
  settings.tolerance = 1e-6;
  const DrivenSolve driven = drive_solver(solver, heavy_problem(), {}, settings);
  CHECK(claims(driven));
  CHECK_FALSE(driven.run.is_solved());
}

TEST_CASE("A backend that gives up says why") {
  Noting solver("pgs");
  DriveSettings settings;
  settings.measure = Measure::fclib;
  settings.tolerance = 1e-9;
  settings.max_iterations = 2;
  const DrivenSolve driven = drive_solver(solver, heavy_problem(), {}, settings);
  CHECK_FALSE(claims(driven));
  CHECK(driven.run.solved.iterations == 2);
  CHECK(driven.run.solved.reason == StopReason::iteration_limit);
}
