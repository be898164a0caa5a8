#pragma once
// A solve that pauses and goes on as if it had not: with its momentum, its weights, its place.

#include <exception>
#include <semaphore>
#include <thread>

#include "platform/clock.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// Runs on a thread of its own, but never beside the caller: one waits while the other works, so
/// that the bits are those of a solve that never paused.
class PausedSolve {
 public:
  /// When to pause, asked like Budget::leave: iterations since the last pause, the error [m/s].
  using Pause = std::function<bool(int iterations, double error)>;

  /// `solver`, prepared for `problem`, and both outlive this. Nothing is done yet. The clock of
  /// `budget` starts here and runs on in pauses; its own `leave` is not asked.
  PausedSolve(Solver& solver, const FrictionProblem& problem, Impulses start, const Budget& budget);
  /// Ends the solve where it stands.
  ~PausedSolve();
  PausedSolve(const PausedSolve&) = delete;
  PausedSolve& operator=(const PausedSolve&) = delete;

  /// Goes on until `pause` says so, or to the end. Returns what came since the last pause: its
  /// iterations, and its history counted from there; `stalled` where it paused. Throws what the
  /// solver throws. Not once it is over.
  Solved go_on(const Pause& pause);
  bool is_over() const { return is_over_; }

 private:
  bool paused(int iterations, double error, const Impulses& r);
  void remember(int iterations, double error);
  void work(Solver& solver, const FrictionProblem& problem, Impulses start, Budget budget);

  const Pause* pause_ = nullptr;
  std::binary_semaphore turn_{0}, back_{0};  ///< the thread's turn; the caller's again
  bool is_over_ = false, is_to_end_ = false;
  std::exception_ptr failure_;
  /// Iterations: at the last pause, until now, and of earlier parts of a solver that begins to
  /// count anew.
  int before_ = 0, iterations_ = 0, earlier_ = 0;
  double began_ = 0.0;  ///< of this turn, on watch_ [s]
  Stopwatch watch_;
  Solved solved_;  ///< of this turn
  std::thread thread_;
};

}  // namespace ballast
