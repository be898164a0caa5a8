#include "solvers/seam/iteration.hpp"

#include <functional>
#include <limits>
#include <thread>

#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Runs a loop whose error after n iterations is error_at(n).
template <typename Error>
Solved run(const Budget& budget, const CheckSchedule& schedule, Error error_at) {
  Iteration iteration(budget, schedule);
  iteration.evaluated(error_at(0), {});
  while (iteration.next())
    if (iteration.error_due()) iteration.evaluated(error_at(iteration.count()), {});
  return iteration.finish({});
}

}  // namespace

TEST_CASE("a first iterate that is good enough stops at once") {
  const Solved solved = run({.tolerance = 1e-3}, {}, [](int) { return 1e-4; });
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.iterations == 0);
  CHECK(solved.own_residual == 1e-4);
}

TEST_CASE("the error is looked at by schedule, and at the limit") {
  const Budget budget{.tolerance = 0.0, .max_iterations = 50, .keep_history = true};
  const Solved solved = run(budget, {4, 1.5}, [](int n) { return 1.0 / (n + 1); });
  CHECK(solved.reason == StopReason::iteration_limit);
  CHECK(solved.iterations == 50);
  CHECK(solved.own_residual == 1.0 / 51);
  std::vector<int> looked;
  for (const HistoryPoint& point : solved.history) looked.push_back(point.iteration);
  CHECK(looked == std::vector<int>{0, 4, 6, 9, 14, 21, 32, 48, 50});
  CHECK(solved.history[2].error == 1.0 / 7);
  CHECK(solved.history[8].seconds >= solved.history[1].seconds);
}

TEST_CASE("far from the tolerance the error is looked at more seldom") {
  const Solved solved = run({.tolerance = 1e-2, .keep_history = true}, {4, 1.5, 2.0},
                            [](int n) { return 1.0 / (n + 1); });
  std::vector<int> looked;
  for (const HistoryPoint& point : solved.history) looked.push_back(point.iteration);
  CHECK(looked == std::vector<int>{0, 4, 8, 16, 24, 36, 54, 81, 122});
  CHECK(solved.reason == StopReason::reached_tolerance);
}

TEST_CASE("without asking there is no history") {
  CHECK(run({.max_iterations = 10}, {}, [](int) { return 1.0; }).history.empty());
}

TEST_CASE("no iteration at all when none is allowed") {
  const Solved solved = run({.max_iterations = 0}, {}, [](int) { return 1.0; });
  CHECK(solved.reason == StopReason::iteration_limit);
  CHECK(solved.iterations == 0);
}

TEST_CASE("the tolerance stops the loop at the first look that meets it") {
  const Solved solved = run({.tolerance = 0.1}, {1, 1.0}, [](int n) { return 1.0 / (n + 1); });
  CHECK(solved.reason == StopReason::reached_tolerance);
  CHECK(solved.iterations ==
        10);  // 1/11; 1/10 is within the margin that is left to the judge's rounding
}

TEST_CASE("numbers that are none stop the loop") {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Solved solved = run({}, {1, 1.0}, [bad](int n) { return n < 3 ? 1.0 + n : bad; });
    CHECK(solved.reason == StopReason::numerical_failure);
    CHECK(solved.iterations == 3);
  }
}

TEST_CASE("an error that no longer changes in any digit is a stall, after a long time") {
  const Solved solved =
      run({.tolerance = 0.0}, {1, 1.1}, [](int n) { return n < 100 ? 1.0 / (n + 1) : 0.5; });
  CHECK(solved.reason == StopReason::stalled);
  CHECK(solved.iterations >= 100 + Iteration::stalled_after);
  CHECK(solved.iterations < 2000);
}

TEST_CASE("time runs out") {
  // On a busy machine the first look alone may take all of a short time.
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

TEST_CASE("who has something better to do leaves at a look, but not what is solved") {
  std::vector<int> asked;
  const LeaveRule leave = [&](int count, double error, const Impulses&) {
    CHECK(error == 1.0 / (count + 1));
    asked.push_back(count);
    return count >= 8;
  };
  const auto error_at = [](int n) { return 1.0 / (n + 1); };
  const Solved left = run({.tolerance = 1e-3, .leave = &leave}, {4, 1.5}, error_at);
  CHECK(left.reason == StopReason::stalled);
  CHECK(left.iterations == 9);
  CHECK(asked == std::vector<int>{0, 4, 6, 9});
  CHECK(run({.tolerance = 0.11, .leave = &leave}, {4, 1.5}, error_at).reason ==
        StopReason::reached_tolerance);
}
