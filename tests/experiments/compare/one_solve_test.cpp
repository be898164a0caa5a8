// Any behaviour of a backend becomes a row, and no claim is believed without the judge.

#include "experiments/compare/one_solve.hpp"

#include <signal.h>

#include <cmath>
#include <set>
#include <thread>

#include "experiments/compare/comparison.hpp"
#include "platform/atomic_file.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/unsolvable.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// A backend that does to its process what a broken one might do.
template <typename Act>
class Misbehaving final : public Solver {
 public:
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem& problem, Impulses start, const Budget&) override {
    Solved solved;
    solved.impulses = std::move(start);
    Act{}(problem, solved);
    return solved;
  }
};

struct Crash {
  void operator()(const FrictionProblem&, Solved&) const { raise(SIGKILL); }
};
struct Hang {
  void operator()(const FrictionProblem&, Solved&) const {
    for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
};
struct Lie {
  void operator()(const FrictionProblem&, Solved& solved) const {
    solved.reason = StopReason::reached_tolerance;
  }
};
struct Throw {
  void operator()(const FrictionProblem&, Solved&) const {
    throw std::runtime_error("thrown on purpose");
  }
};
struct Refuse {
  void operator()(const FrictionProblem&, Solved&) const {
    throw UnsupportedProblem("refuse: on purpose");
  }
};
struct NoMemory {
  void operator()(const FrictionProblem&, Solved&) const { throw std::bad_alloc(); }
};

template <typename Act>
std::unique_ptr<Solver> misbehaving() {
  return std::make_unique<Misbehaving<Act>>();
}

/// A backend that `make` makes. With a `key` it counts as an external program and has no child.
ComparedSolver made_by(MakeSolver make, std::string key = {}) {
  return {"", ContactLaw::coulomb, std::move(make), std::move(key)};
}

/// A single run, without a memory limit: sanitizers reserve terabytes.
const SolveLimits once{.memory_MB = 0.0, .min_timing_seconds = 0.0};

/// The row of a small problem that `make`'s solver solves to `tolerance`.
CompareRow tried(SolverMaker make, double tolerance, double max_seconds = 20.0) {
  static const LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  CompareRow row;
  row.tolerance = tolerance;
  row.max_seconds = max_seconds;
  solve_case(made_by(make), loaded, once, row);
  return row;
}

}  // namespace

TEST_CASE("Whatever a backend does becomes a row") {
  CHECK(tried(misbehaving<Crash>, 1e-6).verdict == Verdict::crashed);
  const CompareRow lie = tried(misbehaving<Lie>, 1e-6);
  CHECK(lie.verdict == Verdict::denied);
  CHECK(lie.error > 1e-6);
  const CompareRow thrown = tried(misbehaving<Throw>, 1e-6);
  CHECK(thrown.verdict == Verdict::unsolved);
  CHECK(thrown.note == "thrown on purpose");
  CHECK(thrown.reason.empty());
  CHECK(std::isnan(thrown.error));
  const CompareRow refused = tried(misbehaving<Refuse>, 1e-6);
  CHECK(refused.verdict == Verdict::unsupported);
  CHECK(refused.note == "refuse: on purpose");
  CHECK(refused.reason.empty());
  CHECK(tried(misbehaving<NoMemory>, 1e-6).verdict == Verdict::out_of_memory);
  // A row without an answer has no error, instead of a small one.
  CHECK(std::isnan(tried(misbehaving<Crash>, 1e-6).error));
}

namespace {
int solves = 0;
struct SolveOnceAndDie {
  void operator()(const FrictionProblem& problem, Solved& solved) const {
    if (solves++ > 0) throw LostProcess("gone", false);
    const std::unique_ptr<Solver> pgs = make_solver("pgs");
    solved = SolverRunner().run(*pgs, problem, {}, {.tolerance = 1e-12}).solved;
  }
};
}  // namespace

TEST_CASE("Of a program that dies in a repeated run nothing counts") {
  const LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  CompareRow row;
  row.tolerance = 1e-4;
  solve_case(made_by(misbehaving<SolveOnceAndDie>, "a program"), loaded,
             {.memory_MB = 0.0, .min_timing_seconds = 60.0}, row);
  CHECK(solves == 2);
  CHECK(row.verdict == Verdict::crashed);
  CHECK((row.reason.empty() && row.runs == 0 && std::isnan(row.error)));
}

TEST_CASE("A case without a solution is said to have none, in either measure") {
  LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  loaded.problem = squeezed_contacts();
  SolveLimits limits = once;
  limits.max_iterations = 2000;
  for (const Measure measure : {Measure::natural_map, Measure::fclib})
    for (const char* name : {"pgs", "apgd"}) {
      CompareRow row;
      row.measure = measure;
      row.tolerance = 1e-6;
      row.max_seconds = 20.0;
      solve_case(made_by(find_solver(name).make), loaded, limits, row);
      CAPTURE(name, row.reason, row.error);
      CHECK(row.verdict == Verdict::no_solution);
      CHECK(row.note.find("no solution") != std::string::npos);
    }
}

TEST_CASE("A solve brings back its answer, its history and where it is worst") {
  const CompareRow row = tried(find_solver("pgs").make, 1e-6);
  CHECK(row.verdict == Verdict::solved);
  CHECK(row.reason == "reached_tolerance");
  CHECK(row.error <= 1e-6);
  CHECK(row.judged.natural_map_rms > 0.0);
  CHECK(row.history.size() > 2);
  CHECK(row.history.back().iteration == row.iterations);
  CHECK_THAT(row.worst, Catch::StartsWith("contact "));
  CHECK(row.runs == 1);
  CHECK(row.peak_memory_MB > 1.0);
}

TEST_CASE("A short solve is repeated in its child, and the fastest run counts") {
  const LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  const SolveLimits limits{.memory_MB = 0.0, .min_timing_seconds = 60.0, .most_runs = 4};
  CompareRow row;
  row.tolerance = 1e-4;
  solve_case(made_by(find_solver("pgs").make), loaded, limits, row);
  CHECK(row.runs == 4);
}

TEST_CASE("A backend that does not stop is stopped") {
  const CompareRow row = tried(misbehaving<Hang>, 1e-4, 0.2);
  CHECK(row.verdict == Verdict::timeout);
  CHECK(row.note.find("killed") != std::string::npos);
  CHECK(row.solve_seconds > 0.2);
}

namespace {
struct StartUp {
  void operator()(const FrictionProblem&, Solved& solved) const { solved.startup_seconds = 5.0; }
};
}  // namespace

TEST_CASE("Start-up is a column of its own, and in no other") {
  const CompareRow row = tried(misbehaving<StartUp>, 1e-6);
  CHECK(row.startup_seconds > 0.0);
  CHECK(row.startup_seconds < 5.0);  // the backend claims more time than has passed
  CHECK(row.solve_seconds == 0.0);
  CHECK(tried(find_solver("pgs").make, 1e-6).startup_seconds > 0.0);  // the time to make the solver
}

namespace {

/// Another backend, with a record of every budget that it was given.
class Noting final : public Solver {
 public:
  Noting(const std::string& name, std::vector<Budget>& budgets)
      : solver_(make_solver(name)), budgets_(budgets) {}
  void prepare(const FrictionProblem& problem) override { solver_->prepare(problem); }
  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    budgets_.push_back(budget);
    return solver_->solve(problem, std::move(start), budget);
  }

 private:
  std::unique_ptr<Solver> solver_;
  std::vector<Budget>& budgets_;
};

LoadedCase heavy_case(double mass_unit) {
  const KnownSolutionSettings settings{
      .bodies = 10, .contacts = 20, .mass_ratio = 100.0, .mass_unit = mass_unit, .seed = 2};
  return load_case(make_known_solution(settings).problem, 5.0);
}

}  // namespace

TEST_CASE("The natural map needs one round, in units of the velocity scale") {
  std::vector<Budget> budgets;
  SolveLimits limits = once;
  limits.max_iterations = 100000;
  CompareRow row;
  row.tolerance = 1e-3;
  solve_case(made_by([&] { return std::make_unique<Noting>("pgs", budgets); }, "key"),
             heavy_case(1.0), limits, row);
  REQUIRE(budgets.size() == 1);
  CHECK(budgets[0].tolerance == 1e-3 * 5.0);
  CHECK(budgets[0].max_iterations == 100000);
  CHECK(budgets[0].max_seconds <= 60.0);
  CHECK(row.verdict == Verdict::solved);
  CHECK(row.judged.natural_map_rms <= 1e-3 * 5.0);
  REQUIRE_FALSE(row.history.empty());
  CHECK(row.history.back().error == Approx(row.judged.natural_map_rms / 5.0));
}

TEST_CASE("Every backend stops on the measure of Siconos, and not far below it") {
  // Methods whose error falls by little between two checks.
  const std::set<std::string> slow = {"pgs", "nncg", "apgd"};
  for (const double mass_unit : {1.0, 1e4}) {  // W ~ 1e-4: the two measures lie far apart
    const LoadedCase loaded = heavy_case(mass_unit);
    for (const SolverEntry& entry : solver_list()) {
      if (!entry.make || entry.law != ContactLaw::coulomb) continue;
      INFO(entry.name << ", masses of " << mass_unit << " kg");
      std::vector<Budget> budgets;
      CompareRow row;
      row.measure = Measure::fclib;
      row.tolerance = 1e-4;
      row.max_seconds = 20.0;
      solve_case(made_by([&] { return std::make_unique<Noting>(entry.name, budgets); }, "key"),
                 loaded, once, row);
      if (row.verdict == Verdict::unsupported) continue;  // NLopt's dense Jacobian: fewer contacts
      CHECK(budgets.size() == 1);
      if (row.reason == "reached_tolerance") CHECK(row.judged.fclib <= 1e-4);
      if (!slow.contains(entry.name)) continue;
      CHECK(row.verdict == Verdict::solved);
      // A method that reaches it at its first check, after eight sweeps, could not stop before.
      if (row.iterations > 8) CHECK(row.judged.fclib > 1e-6);
    }
  }
}

TEST_CASE("A backend that gives up says why, and one that only says so is not believed") {
  CompareRow row;
  row.measure = Measure::fclib;
  row.tolerance = 1e-9;
  SolveLimits limits = once;
  limits.max_iterations = 2;
  solve_case(made_by(find_solver("pgs").make, "key"), heavy_case(1.0), limits, row);
  CHECK(row.iterations == 2);
  CHECK(row.reason == "iteration_limit");
  CHECK(row.verdict == Verdict::unsolved);
  CompareRow lie;
  lie.measure = Measure::fclib;
  lie.tolerance = 1e-6;
  solve_case(made_by(misbehaving<Lie>, "key"), heavy_case(1.0), once, lie);
  CHECK(lie.verdict == Verdict::denied);
}

TEST_CASE("An exact answer is found, kept and judged anew") {
  const KnownSolution known = make_known_solution({.bodies = 10, .contacts = 15, .seed = 2});
  const TemporaryFolder folder;
  const auto found = [&](const FrictionProblem& problem, double seconds) {
    LoadedCase loaded = load_case(problem, 1.0);
    find_exact(loaded, seconds, folder.path() / "exact");
    return loaded.exact;
  };
  const Impulses exact = found(known.problem, 10.0);
  CHECK(contact_error(known.problem, exact).within(1e-9));
  Eigen::VectorXd u;
  contact_velocity(known.problem, exact, u);
  CHECK((u - known.u).norm() < 1e-6 * known.u.norm());
  const auto file = std::filesystem::directory_iterator(folder.path() / "exact")->path();
  const std::string bytes = read_whole_file(file);
  // The stored answer is read; a damaged one, or that of another problem, is computed again.
  for (const std::string& kept : {bytes, bytes.substr(0, 20), std::string(bytes.size(), '\1')}) {
    write_whole_file(file, kept);
    CHECK(found(known.problem, 10.0) == exact);
    CHECK(read_whole_file(file) == bytes);
  }
  CHECK(found(only_delassus(known.problem), 10.0).size() == exact.size());
  CHECK(found(known.problem, 0.0).size() == 0);  // no time, hence not computed
  CHECK(found(squeezed_contacts(), 0.2).size() == 0);
}
