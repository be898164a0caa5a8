#include "solvers/seam/rounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "platform/clock.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/fclib_stop.hpp"
#include "solvers/seam/iteration.hpp"
#include "solvers/seam/relay.hpp"

namespace ballast {
namespace {

/// Rounds without progress: a tenth less error than when it was last seen.
struct Progress {
  double from;
  int idle = 0;

  void see(double best_error, bool is_round_finished) {
    if (best_error < 0.9 * from) {
      from = best_error;
      idle = 0;
    } else if (is_round_finished) {
      ++idle;
    }
  }
};

}  // namespace

Solved solve_in_rounds(const FrictionProblem& problem, const MovingContacts& moving, Impulses start,
                       const Budget& budget, int patience,
                       const std::function<void(const RoundRequest&, RoundAnswer&)>& round) {
  ContactJudge judge;
  // Standing still is judged by rounds, below.
  Iteration iteration(budget, {}, std::numeric_limits<int>::max());
  Impulses r = std::move(start);
  // A foreign solver has stopped by its own measure when the judge looks: that time is not its own.
  const auto error_of = [&](const Eigen::VectorXd& x) {
    const Stopwatch watch;
    moving.scatter(problem, x, r);
    const double error = judge.judge(problem, r).natural_map_rms;
    iteration.add_startup(watch.seconds());
    return error;
  };
  const auto evaluated = [&](const Eigen::VectorXd& x, double error) {
    const Stopwatch watch;
    moving.scatter(problem, x, r);
    if (budget.fclib) budget.fclib->reached(r, error);
    iteration.add_startup(watch.seconds());
    iteration.evaluated(error, r);
  };

  Eigen::VectorXd last;
  moving.gather(problem, r, last);
  Eigen::VectorXd best = last;
  double last_error = error_of(last), best_error = last_error;
  evaluated(best, best_error);
  Progress progress{best_error};
  bool stalled = false;
  RoundAnswer answer;
  while (!stalled && iteration.next()) {
    const Budget left = rest_of(budget, iteration.count() - 1, iteration.seconds());
    answer.x.resize(0);
    answer.iterations = 1;
    answer.seconds = -1.0;
    answer.finished = true;
    const Stopwatch watch;
    round({last, best, last_error, left}, answer);
    if (answer.seconds >= 0.0) iteration.add_startup(watch.seconds() - answer.seconds);
    // The round's own iterations are booked; the loop has counted one.
    for (int i = 1; i < std::min(answer.iterations, left.max_iterations); ++i) iteration.next();
    // The judge looks at what came back.
    if (answer.x.size() == last.size() && answer.x.allFinite()) {
      last = answer.x;
      last_error = error_of(last);
      if (last_error < best_error) {
        best_error = last_error;
        best = last;
      }
    }
    progress.see(best_error, answer.finished);
    iteration.error_due();
    evaluated(best, best_error);
    stalled = progress.idle >= patience;
  }
  moving.scatter(problem, best, r);
  Solved solved = iteration.finish(std::move(r));
  // The loop ended by itself, and none of the budget's reasons applies.
  if (stalled && solved.reason == StopReason::numerical_failure && std::isfinite(best_error))
    solved.reason = StopReason::stalled;
  return solved;
}

}  // namespace ballast
