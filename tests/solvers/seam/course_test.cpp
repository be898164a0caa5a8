#include "solvers/seam/course.hpp"

#include <algorithm>
#include <limits>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/fclib_stop.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("a course keeps the best of all iterates, in whatever order they come") {
  Course course({.tolerance = 1e-3, .max_iterations = 100, .keep_history = true},
                Impulses::Constant(2, 1.0), 0.5);
  CHECK_FALSE(course.over());
  course.spend(10);
  course.offer(Impulses::Constant(2, 2.0), 0.1);
  course.spend(20);
  course.offer(Impulses::Constant(2, 3.0), 0.7);
  CHECK(course.error() == 0.1);
  CHECK(course.best() == Impulses::Constant(2, 2.0));
  CHECK(course.rest().max_iterations == 70);
  CHECK(course.rest().tolerance == 1e-3);
  CHECK_FALSE(course.over());
  const Solved solved = course.finish();
  CHECK(solved.reason == StopReason::stalled);
  CHECK(solved.impulses == Impulses::Constant(2, 2.0));
  CHECK(solved.own_residual == 0.1);
  CHECK(solved.iterations == 30);
  // One point per count, the error that of the best.
  REQUIRE(solved.history.size() == 3);
  CHECK(solved.history[0].error == 0.5);
  CHECK(solved.history[1].iteration == 10);
  CHECK(solved.history[2].iteration == 30);
  CHECK(solved.history[2].error == 0.1);
}

TEST_CASE("iterates of one count are one point of the history, and none without the wish") {
  Course course({.max_iterations = 100, .keep_history = true}, Impulses::Zero(1), 1.0);
  course.spend(3);
  course.offer(Impulses::Ones(1), 0.5);
  course.offer(Impulses::Ones(1), 0.25);
  const Solved solved = course.finish();
  REQUIRE(solved.history.size() == 2);
  CHECK(solved.history[1].error == 0.25);
  CHECK(Course({}, Impulses::Zero(1), 1.0).finish().history.empty());
}

namespace {

/// Comes to `error` after three iterations, from a start of error 0.5.
struct Opener final : Solver {
  double error;
  StopReason reason;
  Opener(double e, StopReason why) : error(e), reason(why) {}
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem&, Impulses start, const Budget& budget) override {
    CHECK(budget.keep_history);
    CHECK((*budget.leave)(3, error, start));
    Solved solved;
    solved.impulses = start + Impulses::Ones(1);
    solved.reason = reason;
    solved.iterations = 3;
    solved.own_residual = error;
    solved.history = {{0, 0.0, 0.5}, {2, 0.1, 0.7}, {3, 0.2, error}};
    return solved;
  }
};

}  // namespace

TEST_CASE("another solver opens a course, which goes on from the better of its ends") {
  const std::function<bool(int, double)> enough = [](int, double) { return true; };
  for (const double error : {0.4, 0.6}) {
    Opener opener(error, StopReason::stalled);
    Course course({.tolerance = 0.1, .max_iterations = 10, .keep_history = true}, opener, {},
                  Impulses::Ones(1), enough);
    CHECK_FALSE(course.over());
    CHECK(course.error() == std::min(error, 0.5));
    CHECK(course.best()[0] == (error < 0.5 ? 2.0 : 1.0));
    CHECK(course.rest().max_iterations == 7);
    const Solved solved = course.finish();
    REQUIRE(solved.history.size() == 3);
    CHECK(solved.history[1].error == 0.5);
    CHECK(solved.history[2].error == std::min(error, 0.5));
  }
  // Who gave the budget is asked first.
  const std::function<bool(int, double)> never = [](int, double) { return false; };
  const LeaveRule leave = [](int, double, const Impulses&) { return true; };
  Opener called_off(0.4, StopReason::stalled);
  Course ended({.tolerance = 0.1, .leave = &leave}, called_off, {}, Impulses::Ones(1), never);
  CHECK(ended.over());
  CHECK(ended.finish().reason == StopReason::stalled);
  Opener arrives(0.05, StopReason::reached_tolerance);
  Course reached({.tolerance = 0.1}, arrives, {}, Impulses::Ones(1), enough);
  CHECK(reached.over());
  const Solved solved = reached.finish();
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.impulses[0] == 2.0);
  CHECK(solved.history.empty());
}

TEST_CASE("a course is over at the tolerance, at a limit, or where nothing is finite") {
  Course reached({.tolerance = 0.1}, Impulses::Zero(1), 0.05);
  CHECK(reached.over());
  CHECK(reached.finish().reason == StopReason::reached_tolerance);
  // Within rounding of the tolerance: the judge might sum to the other side of it.
  Course nearly({.tolerance = 0.1}, Impulses::Zero(1), 0.1);
  CHECK_FALSE(nearly.over());
  Course counted({.tolerance = 0.0, .max_iterations = 5}, Impulses::Zero(1), 0.05);
  counted.spend(5);
  CHECK(counted.over());
  CHECK(counted.finish().reason == StopReason::iteration_limit);
  Course late({.tolerance = 0.0, .max_seconds = 0.0}, Impulses::Zero(1), 0.05);
  CHECK(late.over());
  CHECK(late.finish().reason == StopReason::time_limit);
  Course broken({}, Impulses::Zero(1), std::numeric_limits<double>::infinity());
  CHECK(broken.over());
  CHECK(broken.finish().reason == StopReason::numerical_failure);
}

TEST_CASE("who gave the budget may call a course off, and is asked with all its iterations") {
  std::vector<int> asked;
  const LeaveRule leave = [&](int iterations, double error, const Impulses&) {
    asked.push_back(iterations);
    return error < 0.3;
  };
  Course course({.tolerance = 1e-9, .leave = &leave}, Impulses::Zero(1), 1.0);
  course.spend(7);
  course.offer(Impulses::Ones(1), 0.5);
  CHECK_FALSE(course.over());
  CHECK(course.rest().leave == nullptr);  // a part counts from 0 again
  course.spend(5);
  course.offer(Impulses::Ones(1), 0.2);
  CHECK(asked == std::vector{7, 12});
  CHECK(course.over());
  CHECK(course.finish().reason == StopReason::stalled);
}

TEST_CASE("a course that is asked for Siconos' measure ends with the iterate that satisfies it") {
  const KnownSolution known = make_known_solution({});
  FclibStop fclib(known.problem, 1e-6);
  Course course({.tolerance = 0.0, .max_iterations = 10, .fclib = &fclib}, 0.0 * known.r, 0.5);
  CHECK_FALSE(course.over());
  course.offer(known.r, 0.4);
  CHECK(course.over());
  course.offer(0.0 * known.r, 0.3);  // comes too late
  const Solved solved = course.finish();
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.impulses == known.r);
}

namespace {

/// Three iterations, the second with the error 0.2, the last with 0.3; asks to go on after each.
struct Walker final : Solver {
  void prepare(const FrictionProblem&) override {}
  Solved solve(const FrictionProblem&, Impulses start, const Budget& budget) override {
    Solved solved;
    for (const double error : {0.6, 0.4, 0.2, 0.3}) {
      solved.history.push_back({solved.iterations, 0.0, error});
      if (budget.leave && (*budget.leave)(solved.iterations, error, start)) break;
      if (solved.iterations == budget.max_iterations) break;
      ++solved.iterations;
    }
    solved.iterations = solved.history.back().iteration;
    solved.impulses = start.array() + solved.iterations;
    solved.history.push_back({solved.iterations, 0.0, 0.2});
    return solved;
  }
};

}  // namespace

TEST_CASE("another solver goes on from the best, its factorisations and history counted") {
  int factorisations = 4;
  std::vector<std::pair<int, double>> asked;
  std::vector<int> counted;
  const LeaveRule leave = [&](int iterations, double error, const Impulses&) {
    asked.push_back({iterations, error});
    counted.push_back(factorisations);
    return false;
  };
  Course course({.tolerance = 1e-3,
                 .max_iterations = 100,
                 .keep_history = true,
                 .leave = &leave,
                 .factorisations = &factorisations},
                Impulses::Constant(1, 7.0), 0.5);
  course.spend(10);
  Walker walker;
  course.factor_by(walker, FrictionProblem{}, 50);
  CHECK(factorisations == 4 + 3);
  CHECK(course.best() == Impulses::Constant(1, 10.0));
  CHECK(course.error() == 0.2);
  REQUIRE(asked.size() >= 4);
  CHECK(asked[0] == std::pair(10, 0.5));  // never worse than the best
  CHECK(asked[2] == std::pair(12, 0.2));
  CHECK(counted[2] == 4 + 2);  // whoever is asked knows what has been factored
  CHECK(course.rest().max_iterations == 87);
  const Solved solved = course.finish();
  CHECK(solved.iterations == 13);
  for (size_t k = 1; k < solved.history.size(); ++k) {
    CHECK(solved.history[k].iteration >= solved.history[k - 1].iteration);
    CHECK(solved.history[k].error <= solved.history[k - 1].error);
  }
}

TEST_CASE("another solver is stopped by its own limit and by who gave the budget") {
  Walker walker;
  Course limited({.tolerance = 1e-3, .max_iterations = 100}, Impulses::Zero(1), 0.9);
  limited.factor_by(walker, FrictionProblem{}, 2);
  CHECK(limited.finish().iterations == 2);
  const LeaveRule leave = [](int iterations, double, const Impulses&) { return iterations >= 1; };
  Course left({.tolerance = 1e-3, .max_iterations = 100, .leave = &leave}, Impulses::Zero(1), 0.9);
  left.factor_by(walker, FrictionProblem{}, 50);
  CHECK(left.over());
}
