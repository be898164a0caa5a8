#include "solvers/seam/paused_solve.hpp"

#include <utility>

namespace ballast {

PausedSolve::PausedSolve(Solver& solver, const FrictionProblem& problem, Impulses start,
                         const Budget& budget)
    : thread_([this, &solver, &problem, start = std::move(start), budget]() mutable {
        turn_.acquire();
        if (!is_to_end_) work(solver, problem, std::move(start), budget);
        is_over_ = true;
        back_.release();
      }) {}

PausedSolve::~PausedSolve() {
  is_to_end_ = true;
  if (!is_over_) turn_.release();
  thread_.join();
}

/// On the thread.
void PausedSolve::work(Solver& solver, const FrictionProblem& problem, Impulses start,
                       Budget budget) {
  const LeaveRule leave = [this](int iterations, double error, const Impulses& r) {
    return paused(iterations, error, r);
  };
  budget.leave = &leave;
  budget.keep_history = true;  // its last point is the error of what is returned
  try {
    Solved whole = solver.solve(problem, std::move(start), budget);
    const double error = whole.history.empty() ? 1e300 : whole.history.back().error;
    remember(whole.iterations, error);
    whole.history = std::move(solved_.history);
    solved_ = std::move(whole);
    iterations_ = solved_.iterations;
  } catch (...) {
    failure_ = std::current_exception();
  }
}

/// One point per count of iterations, the last one that was true of it.
void PausedSolve::remember(int iterations, double error) {
  std::vector<HistoryPoint>& history = solved_.history;
  if (!history.empty() && history.back().iteration == iterations - before_) history.pop_back();
  history.push_back({iterations - before_, watch_.seconds() - began_, error});
}

/// On the thread, at every look. True: the solve is to end.
bool PausedSolve::paused(int iterations, double error, const Impulses& r) {
  if (is_to_end_) return true;
  if (earlier_ + iterations < iterations_) earlier_ = iterations_;
  iterations_ = earlier_ + iterations;
  remember(iterations_, error);
  if (!(*pause_)(iterations_ - before_, error)) return false;
  solved_.impulses = r;
  solved_.own_residual = error;
  back_.release();
  turn_.acquire();
  return is_to_end_;
}

Solved PausedSolve::go_on(const Pause& pause) {
  pause_ = &pause;
  before_ = iterations_;
  began_ = watch_.seconds();
  solved_.history.clear();
  solved_.reason = StopReason::stalled;
  turn_.release();
  back_.acquire();
  if (failure_) std::rethrow_exception(failure_);
  Solved turn = is_over_ ? std::move(solved_) : solved_;
  turn.iterations = iterations_ - before_;
  return turn;
}

}  // namespace ballast
