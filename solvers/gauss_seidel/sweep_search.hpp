#pragma once
// Gauss-Seidel sweeps accelerated by a search: after each sweep the iterate goes on in a direction
// made of what the sweeps before have changed. Only swept iterates, which lie in the cones, are
// ever judged or returned.

#include <limits>
#include <utility>

#include "solvers/gauss_seidel/any_sweep.hpp"

namespace ballast {

/// When to look at the error. The square of what a sweep changes comes for nothing, and while a
/// solve goes on it stays in one proportion to the square of the error, within a tenth.
class SweptChange {
 public:
  explicit SweptChange(double aim) : aim_(aim) {}

  /// After a look at the error [m/s].
  void seen(int sweeps, double square, double error) {
    next_ = sweeps + apart;
    enough_ = square * (near * aim_ / error) * (near * aim_ / error);
  }
  /// The error is likely to be small enough.
  bool promises(int sweeps, double square) const { return sweeps >= next_ && square <= enough_; }

 private:
  static constexpr int apart = 4;  // sweeps between two looks, at least
  static constexpr double near = 0.97;
  double aim_, enough_ = -1.0;
  int next_ = 0;
};

/// The backend that a rule makes of it. `Rule` has
///   void forget();                    the search begins at the current iterate
///   SearchStep next(double square);   of the next sweep; square: what the last one changed
///   void see(double error);           told at each look
///   bool begins_anew() const;         asked after it: the search ends, and begins at the iterate
template <typename Rule>
class SweepSearch final : public Solver {
 public:
  /// `returns_best`: of the iterates that were looked at, where a limit ends a solve; else the
  /// last. A search may come to iterates far worse than one before.
  explicit SweepSearch(bool returns_best) : returns_best_(returns_best) {}

  void prepare(const FrictionProblem& problem) override { sweep_.prepare(problem); }
  void use_team(WorkerTeam* team) override { sweep_.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {8, 1.3, 1.5});
    SweptChange change(budget.aim());
    Rule rule;
    const auto begin = [&] {
      rule.forget();
      sweep_->start_search();
    };
    const auto load = [&] {
      sweep_->load(problem, r);
      begin();
    };
    allow_single(*sweep_, budget);
    load();
    sweep_->store(problem, r);
    const double first_error = sweep_->error();
    rule.see(first_error);
    iteration.evaluated(first_error, r);
    Impulses best(returns_best_ ? problem.row_count() : 0);  // of all looks
    bool is_best = false;
    double least = std::numeric_limits<double>::infinity(), square = 0.0;
    const auto remember = [&](double error) {
      is_best = error < least;
      if (!is_best) return;
      least = error;
      best.swap(r);  // the next look fills r anew
    };
    if (returns_best_) remember(first_error);
    while (iteration.next()) {
      square = sweep_->sweep_along(rule.next(square));
      if (!iteration.error_due() && !change.promises(iteration.count(), square)) continue;
      const double error = swept_error(*sweep_, problem, iteration, r, load);
      iteration.evaluated(error, r);
      if (returns_best_) remember(error);
      change.seen(iteration.count(), square, error);
      rule.see(error);
      if (rule.begins_anew()) begin();
    }
    Solved solved = iteration.finish(std::move(is_best ? best : r));
    if (returns_best_ && !is_best && solved.reason != StopReason::reached_tolerance)
      go_back(problem, best, solved);
    return solved;
  }

 private:
  /// To the best, swept once more in double: what is returned obeys each contact's law.
  void go_back(const FrictionProblem& problem, const Impulses& best, Solved& solved) {
    sweep_->allow_single(false);
    sweep_->load(problem, best);
    sweep_->sweep();
    const double error = sweep_->error();
    if (error >= solved.own_residual) return;
    sweep_->store(problem, solved.impulses);
    solved.own_residual = error;
    if (!solved.history.empty()) solved.history.back().error = error;
  }

  bool returns_best_;
  AnySweep sweep_;
};

}  // namespace ballast
