// Whatever a backend does to its process becomes a row, and nobody is believed without the judge.

#include "experiments/compare/solve_child.hpp"

#include <signal.h>

#include <cmath>
#include <thread>

#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/unsolvable.hpp"

using namespace ballast;

namespace {

/// A backend of the test that does to the process what a broken one might.
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

/// A small problem tried by `make` to `tolerance`.
CompareRow tried(SolverMaker make, double tolerance, double max_seconds = 20.0) {
  static const LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  DriveSettings drive;
  drive.max_seconds = max_seconds;
  ChildLimits limits;
  limits.memory_MB = 0.0;  // sanitizers reserve terabytes
  limits.warm_seconds = 0.0;
  CompareRow row;
  row.tolerance = tolerance;
  solve_in_child(make, loaded, drive, limits, row);
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
  const CompareRow refused = tried(misbehaving<Refuse>, 1e-6);
  CHECK(refused.verdict == Verdict::unsupported);
  CHECK(refused.note == "refuse: on purpose");
  CHECK(refused.reason.empty());
  CHECK(tried(misbehaving<NoMemory>, 1e-6).verdict == Verdict::out_of_memory);
  // a row without an answer has no error, not a small one
  CHECK(std::isnan(tried(misbehaving<Crash>, 1e-6).error));
}

TEST_CASE("A case without a solution is said to have none, in either measure") {
  LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  loaded.problem = squeezed_contacts();
  DriveSettings drive;
  drive.max_seconds = 20.0;
  drive.max_iterations = 2000;
  ChildLimits limits;
  limits.memory_MB = 0.0;
  limits.warm_seconds = 0.0;
  for (const Measure measure : {Measure::natural_map, Measure::fclib})
    for (const char* name : {"pgs", "apgd"}) {
      CompareRow row;
      row.measure = measure;
      row.tolerance = 1e-6;
      solve_in_child(find_solver(name).make, loaded, drive, limits, row);
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
  CHECK(row.natural_map_rms > 0.0);
  CHECK(row.history.size() > 2);
  CHECK(row.history.back().iteration == row.iterations);
  CHECK(row.worst_contact >= 0);
  CHECK(row.worst == "contact " + std::to_string(row.worst_contact));
  CHECK(row.runs == 1);
  CHECK(row.first_seconds == row.seconds());
  CHECK(row.peak_memory_MB > 1.0);
}

TEST_CASE("A short solve is repeated in its child, and the fastest run counts") {
  const LoadedCase loaded = compare_cases({"known:contacts=12,bodies=6,seed=3"})[0].load();
  ChildLimits limits;
  limits.memory_MB = 0.0;
  limits.warm_seconds = 60.0;
  limits.most_runs = 4;
  CompareRow row;
  row.tolerance = 1e-4;
  solve_in_child(find_solver("pgs").make, loaded, DriveSettings{}, limits, row);
  CHECK(row.runs == 4);
  CHECK(row.seconds() <= row.first_seconds);
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
  CHECK(row.startup_seconds >= 5.0);
  CHECK(row.seconds() < 0.0);
  CHECK(tried(find_solver("pgs").make, 1e-6).startup_seconds > 0.0);  // making the solver
}
