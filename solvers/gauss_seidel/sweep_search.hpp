#pragma once
// Gauss-Seidel sweeps accelerated by a search: after each sweep the iterate goes on in a direction
// made of what the sweeps before have changed. Only swept iterates, which lie in the cones, are
// ever judged or returned.

#include <limits>
#include <utility>

#include "solvers/gauss_seidel/body_sweep.hpp"
#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "solvers/gauss_seidel/either_form.hpp"
#include "solvers/gauss_seidel/swept_error.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {

/// The sweep over bodies along its search: velocities are linear in the impulses and take the same
/// combination of their own past, so that nothing is recomputed.
struct BodySearch {
  BodySweep sweep;

  void start() { sweep.start_search(); }
  /// Moves along the search, then sweeps. Returns the square of what the sweep changed.
  double advance(SearchStep step) { return sweep.sweep(step); }
};

/// The same over a stored W, whose sweep keeps impulses alone.
struct MatrixSearch {
  DelassusSweep sweep;
  Eigen::VectorXd swept, before, direction;

  void start() {
    sweep.save(before);
    direction.setZero(before.size());
  }
  double advance(SearchStep step) {
    sweep.save(swept);
    before = swept - before;
    direction = step.beta * direction + step.ahead * before;
    swept += direction;
    direction += step.gain * before;
    before = swept;
    sweep.restore(swept);
    sweep.sweep();
    sweep.save(swept);
    return (swept - before).squaredNorm();
  }
};

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

  void prepare(const FrictionProblem& problem) override {
    searches_.visit(problem, [&](auto& search) { search.sweep.prepare(problem); });
  }

  void use_team(WorkerTeam* team) override { searches_.bodies.sweep.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    return searches_.visit(
        problem, [&](auto& search) { return iterate(search, problem, std::move(start), budget); });
  }

 private:
  template <typename Search>
  Solved iterate(Search& search, const FrictionProblem& problem, Impulses r, const Budget& budget) {
    Iteration iteration(budget, {8, 1.3, 1.5});
    SweptChange change(budget.aim());
    Rule rule;
    const auto begin = [&] {
      rule.forget();
      search.start();
    };
    const auto load = [&] {
      search.sweep.load(problem, r);
      begin();
    };
    allow_single(search.sweep, budget);
    load();
    search.sweep.store(problem, r);
    const double first_error = search.sweep.error();
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
      square = search.advance(rule.next(square));
      if (!iteration.error_due() && !change.promises(iteration.count(), square)) continue;
      const double error = swept_error(search.sweep, problem, iteration, r, load);
      iteration.evaluated(error, r);
      if (returns_best_) remember(error);
      change.seen(iteration.count(), square, error);
      rule.see(error);
      if (rule.begins_anew()) begin();
    }
    Solved solved = iteration.finish(std::move(is_best ? best : r));
    if (returns_best_ && !is_best && solved.reason != StopReason::reached_tolerance)
      go_back(search, problem, best, solved);
    return solved;
  }

  /// To the best, swept once more in double: what is returned obeys each contact's law.
  template <typename Search>
  static void go_back(Search& search, const FrictionProblem& problem, const Impulses& best,
                      Solved& solved) {
    if constexpr (requires { search.sweep.allow_single(false); }) search.sweep.allow_single(false);
    search.sweep.load(problem, best);
    search.sweep.sweep();
    const double error = search.sweep.error();
    if (error >= solved.own_residual) return;
    search.sweep.store(problem, solved.impulses);
    solved.own_residual = error;
    if (!solved.history.empty()) solved.history.back().error = error;
  }

  bool returns_best_;
  EitherForm<BodySearch, MatrixSearch> searches_;
};

}  // namespace ballast
