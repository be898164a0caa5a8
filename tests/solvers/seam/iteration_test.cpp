#include "solvers/seam/iteration.hpp"

#include <cmath>
#include <limits>
#include <thread>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;

namespace {

/// Runs a loop whose error after n iterations is error_at(n).
template <typename Error>
Solved run(const Budget& budget, const CheckSchedule& schedule, Error error_at) {
  Iteration iteration(budget, schedule);
  iteration.evaluated(error_at(0), {});
  while (iteration.next())
    if (iteration.is_error_due()) iteration.evaluated(error_at(iteration.count()), {});
  return iteration.finish({});
}

double harmonic(int n) { return 1.0 / (n + 1); }

}  // namespace

TEST_CASE("the error is looked at by schedule, at the limit, and more seldom far from the goal") {
  const auto looks = [&](const Budget& budget, const CheckSchedule& schedule) {
    std::vector<int> looked;
    for (const HistoryPoint& point : run(budget, schedule, harmonic).history) {
      looked.push_back(point.iteration);
      CHECK(point.error == harmonic(point.iteration));
    }
    return looked;
  };
  CHECK(looks({.tolerance = 0.0, .max_iterations = 50, .keep_history = true}, {4, 1.5}) ==
        std::vector{0, 4, 6, 9, 14, 21, 32, 48, 50});
  CHECK(looks({.tolerance = 1e-2, .keep_history = true}, {4, 1.5, 2.0}) ==
        std::vector{0, 4, 8, 16, 24, 36, 54, 81, 122});
  CHECK(looks({.max_iterations = 10}, {}).empty());
}

TEST_CASE("why a loop stops, and when") {
  using enum StopReason;
  using Limits = std::numeric_limits<double>;
  struct Case {
    const char* what;
    Budget budget;
    double (*error_at)(int);
    StopReason reason;
    int iterations;
  };
  const auto small = [](int) { return 1e-4; };
  const auto not_a_number = [](int n) { return n < 3 ? 1.0 + n : Limits::quiet_NaN(); };
  const auto infinite = [](int n) { return n < 3 ? 1.0 + n : Limits::infinity(); };
  const auto stands = [](int n) { return n < 100 ? harmonic(n) : 0.5; };
  for (const Case& c : {
           Case{"a start that is good enough", {.tolerance = 1e-3}, small, reached_tolerance, 0},
           // The error is 1/11; 1/10 is within the margin for the judge's rounding.
           {"the first look that meets it", {.tolerance = 0.1}, harmonic, reached_tolerance, 10},
           {"none allowed", {.max_iterations = 0}, harmonic, iteration_limit, 0},
           {"not a number", {}, not_a_number, numerical_failure, 3},
           {"infinite", {}, infinite, numerical_failure, 3},
           {"no digit changes any more",
            {.tolerance = 0.0},
            stands,
            stalled,
            100 + Iteration::stalled_after},
       }) {
    CAPTURE(c.what);
    const Solved solved = run(c.budget, {1, 1.0}, c.error_at);
    CHECK(solved.reason == c.reason);
    CHECK(solved.iterations == c.iterations);
    if (std::isfinite(solved.own_residual)) CHECK(solved.own_residual == c.error_at(c.iterations));
  }
}

TEST_CASE("time runs out") {
  // On a busy machine the first check alone may use up a short time.
  int iterations = 0;
  for (double seconds = 0.02; iterations <= 1 && seconds < 60.0; seconds *= 2.0) {
    const Solved solved = run({.tolerance = 0.0, .max_iterations = 1 << 30, .max_seconds = seconds},
                              {1 << 30, 2.0}, [](int n) {
                                if (n == 0)
                                  std::this_thread::sleep_for(std::chrono::milliseconds(1));
                                return 1.0;
                              });
    CHECK(solved.reason == StopReason::time_limit);
    iterations = solved.iterations;
  }
  CHECK(iterations > 1);
}

TEST_CASE("a solve that is cancelled ends at the next look at the clock") {
  Budget budget{.tolerance = 0.0, .max_iterations = 1000};
  int asked = 0;
  budget.is_cancelled = [&] { return ++asked > 10; };
  const Solved solved = run(budget, {4, 1.5}, harmonic);
  CHECK(solved.reason == StopReason::time_limit);
  CHECK(solved.iterations < 11);
  Course course(budget, Impulses::Zero(3));
  CHECK(course.over());
}

TEST_CASE("who has something better to do gives up at a look, but not what is solved") {
  std::vector<int> asked;
  const auto gives_up = [&](int count, double error) {
    CHECK(error == harmonic(count));
    asked.push_back(count);
    return count >= 8;
  };
  const Solved left = run({.tolerance = 1e-3, .gives_up = gives_up}, {4, 1.5}, harmonic);
  CHECK(left.reason == StopReason::stalled);
  CHECK(left.iterations == 9);
  CHECK(asked == std::vector<int>{0, 4, 6, 9});
  CHECK(run({.tolerance = 0.11, .gives_up = gives_up}, {4, 1.5}, harmonic).reason ==
        StopReason::reached_tolerance);
}

namespace {

/// A solve in a course: it begins at `start` and may spend `left`.
using Part = std::function<Solved(Impulses start, const Budget& left)>;

void run(Course& course, const Part& part) {
  struct Once final : Solver {
    explicit Once(const Part& given) : part(given) {}
    void prepare(const FrictionProblem&) override {}
    Solved solve(const FrictionProblem&, Impulses start, const Budget& left) override {
      return part(std::move(start), left);
    }
    const Part& part;
  } solver(part);
  course.run(solver, {}, 1 << 30);
}

/// Goes from the error 0.5 to `error` in `iterations`. All its impulses are `impulse`.
Part part(int iterations, double impulse, double error,
          StopReason reason = StopReason::iteration_limit) {
  return [=](Impulses start, const Budget& left) {
    CHECK_FALSE(left.gives_up);
    Solved solved;
    solved.impulses = Impulses::Constant(start.size(), impulse);
    solved.reason = reason;
    solved.iterations = iterations;
    solved.start_error = 0.5;
    solved.end_error = error;
    if (left.keep_history) solved.history = {{0, 0.0, 0.5}, {iterations, 1e-3, error}};
    return solved;
  };
}

Course course_at(double error, const Budget& budget = {.tolerance = 0.0, .max_iterations = 100}) {
  Course course(budget, Impulses::Zero(1));
  course.offer(course.best(), error);
  return course;
}

/// The iteration counts and errors of the history.
using Points = std::vector<std::pair<int, double>>;
Points points_of(const Solved& solved) {
  Points points;
  for (const HistoryPoint& point : solved.history)
    points.emplace_back(point.iteration, point.error);
  return points;
}

}  // namespace

TEST_CASE("a course keeps the best of all iterates, in whatever order they come") {
  Course course = course_at(0.5, {.tolerance = 1e-3, .max_iterations = 100, .keep_history = true});
  course.spend(10);
  course.offer(Impulses::Constant(1, 2.0), 0.2);
  course.offer(Impulses::Constant(1, 3.0), 0.1);  // at the same count
  course.spend(20);
  course.offer(Impulses::Constant(1, 4.0), 0.7);
  CHECK(course.error() == 0.1);
  CHECK(course.rest().max_iterations == 70);
  CHECK(course.rest().tolerance == 1e-3);
  CHECK_FALSE(course.over());
  const Solved solved = course.finish();
  CHECK(solved.reason == StopReason::stalled);
  CHECK(solved.impulses == Impulses::Constant(1, 3.0));
  CHECK(solved.own_residual == 0.1);
  CHECK(solved.iterations == 30);
  // One point per count, with the error of the best.
  CHECK(points_of(solved) == Points{{0, 0.5}, {10, 0.1}, {30, 0.1}});
  CHECK(course_at(1.0).finish().history.empty());
}

TEST_CASE("every part begins at the best iterate, and has what the others left") {
  Course course({.tolerance = 0.0, .max_iterations = 100, .keep_history = true},
                Impulses::Constant(3, 5.0));
  run(course, part(5, 0.0, 0.9));  // worse than the start, whose error it reports
  CHECK(course.error() == 0.5);
  CHECK(course.best() == Impulses::Constant(3, 5.0));
  run(course, part(25, 1.0, 0.4));
  run(course, part(20, 2.0, 0.45));  // worse: not kept
  run(course, [](Impulses start, const Budget& left) {
    CHECK(start == Impulses::Constant(3, 1.0));
    CHECK(left.max_iterations == 50);
    CHECK(left.keep_history);
    return part(10, 3.0, 0.25)(start, left);
  });
  CHECK(course.count() == 60);
  CHECK_FALSE(course.over());
  const Solved solved = course.finish();
  CHECK(solved.impulses == Impulses::Constant(3, 3.0));
  CHECK(solved.reason == StopReason::stalled);
  // The errors are those of the iterate that is kept.
  CHECK(points_of(solved) == Points{{0, 0.5}, {5, 0.5}, {30, 0.4}, {50, 0.4}, {60, 0.25}});
}

TEST_CASE("a course is over at the tolerance, at a limit, or where nothing is finite") {
  const auto end_of = [](Course course, bool is_over) {
    CHECK(course.over() == is_over);
    return course.finish().reason;
  };
  CHECK(end_of(course_at(0.05, {.tolerance = 0.1}), true) == StopReason::reached_tolerance);
  // Within rounding of the tolerance: the judge might sum to the other side of it.
  CHECK(end_of(course_at(0.1, {.tolerance = 0.1}), false) == StopReason::stalled);
  CHECK(end_of(course_at(0.05, {.tolerance = 0.0, .max_seconds = 0.0}), true) ==
        StopReason::time_limit);
  CHECK(end_of(course_at(std::numeric_limits<double>::infinity()), true) ==
        StopReason::numerical_failure);
  Course counted = course_at(0.05);
  counted.spend(100);
  CHECK(end_of(counted, true) == StopReason::iteration_limit);
  // A part's claim to have reached the tolerance is the answer, even if a smaller error is known.
  Course reached = course_at(0.5);
  run(reached, part(20, 2.0, 0.9, StopReason::reached_tolerance));
  CHECK(reached.best() == Impulses::Constant(1, 2.0));
  CHECK(end_of(reached, true) == StopReason::reached_tolerance);
  // A failing part leaves the best iterate.
  Course failed = course_at(0.4);
  run(failed, [](Impulses start, const Budget& left) {
    CHECK_FALSE(left.keep_history);  // not requested
    return part(0, 1.0, 0.5)(start, left);
  });
  run(failed,
      part(3, 1.0, std::numeric_limits<double>::quiet_NaN(), StopReason::numerical_failure));
  CHECK(failed.best() == Impulses::Zero(1));
  CHECK(end_of(failed, false) == StopReason::stalled);
}

TEST_CASE("a course that is asked for Siconos' measure ends with the iterate that satisfies it") {
  const KnownSolution known = make_known_solution({});
  FclibStop fclib(known.problem, 1e-6);
  Course course({.tolerance = 0.0, .max_iterations = 10, .fclib = &fclib}, 0.0 * known.r);
  course.offer(0.0 * known.r, 0.5);
  CHECK_FALSE(course.over());
  course.offer(known.r, 0.6);
  CHECK(course.over());
  course.offer(0.0 * known.r, 0.3);  // too late
  const Solved solved = course.finish();
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.impulses == known.r);
}

TEST_CASE("two parts of plain Gauss-Seidel end where one of both lengths does") {
  const FrictionProblem problem = make_known_solution({.bodies = 10, .contacts = 8}).problem;
  const auto solver = make_gauss_seidel();
  const Budget budget{.tolerance = 0.0, .max_iterations = 30};
  const Solved whole = from_rest(*solver, problem, budget);
  Course course(budget, Impulses::Zero(problem.row_count()));
  course.run(*solver, problem, 10);
  CHECK(course.count() == 10);
  course.run(*solver, problem, 1000);
  const Solved both = course.finish();
  CHECK(both.iterations == 30);
  CHECK((both.impulses - whole.impulses).norm() <= 1e-12 * whole.impulses.norm());
}
