#include "solvers/backends/auto.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "solvers/backends/anderson_pgs.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/nncg.hpp"

namespace ballast {
namespace {

/// One solve as a series of rounds by other backends: counts, clock and history of all of them.
class Rounds {
 public:
  Rounds(const Budget& budget, Impulses start)
      : budget_(budget), begin_(std::chrono::steady_clock::now()) {
    solved_.impulses = std::move(start);
    solved_.reason = StopReason::stalled;
  }

  /// Runs `solver` from the best iterate for at most `iterations`. Returns the error reached [m/s].
  double run(Solver& solver, const FrictionProblem& problem, int iterations) {
    const double elapsed = seconds();
    Budget round{
        .tolerance = budget_.tolerance,
        .max_iterations = std::min(iterations, budget_.max_iterations - solved_.iterations),
        .max_seconds = std::max(0.0, budget_.max_seconds - elapsed),
        .keep_history = true};
    Solved part = solver.solve(problem, solved_.impulses, round);
    const double error = part.history.empty() ? error_ : part.history.back().error;
    for (const HistoryPoint& point : part.history)
      if (budget_.keep_history && (solved_.history.empty() || point.iteration > 0))
        solved_.history.push_back(
            {solved_.iterations + point.iteration, elapsed + point.seconds, point.error});
    solved_.iterations += part.iterations;
    solved_.own_residual = part.own_residual;
    if (!(error > error_)) {  // a round of sweeps may end worse than it began
      solved_.impulses = std::move(part.impulses);
      error_ = error;
    } else if (budget_.keep_history && !solved_.history.empty()) {
      solved_.history.back().error = error_;
    }
    reached_ = part.reason == StopReason::reached_tolerance;
    if (part.reason == StopReason::numerical_failure) failed_ = true;
    return error_;
  }

  bool over() const {
    return reached_ || failed_ || solved_.iterations >= budget_.max_iterations ||
           seconds() >= budget_.max_seconds;
  }
  int iterations() const { return solved_.iterations; }
  double error() const { return error_; }

  Solved take() {
    if (reached_)
      solved_.reason = StopReason::reached_tolerance;
    else if (solved_.iterations >= budget_.max_iterations)
      solved_.reason = StopReason::iteration_limit;
    else if (seconds() >= budget_.max_seconds)
      solved_.reason = StopReason::time_limit;
    return std::move(solved_);
  }

 private:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }

  Budget budget_;
  std::chrono::steady_clock::time_point begin_;
  Solved solved_;
  double error_ = 1e300;
  bool reached_ = false, failed_ = false;
};

class Auto final : public Solver {
 public:
  Auto()
      : matrix_opening_(make_anderson_pgs({})),
        matrix_sweeps_(make_gauss_seidel({})),
        body_sweeps_(make_nncg()),
        newton_(make_proximal_newton({.start_sweeps = 0})) {}

  void prepare(const FrictionProblem& problem) override {
    sweeps_ = problem.has_dynamics ? body_sweeps_.get() : matrix_sweeps_.get();
    opening_ = problem.has_dynamics ? body_sweeps_.get() : matrix_opening_.get();
    opening_->prepare(problem);
    if (opening_ != sweeps_) sweeps_->prepare(problem);
    newton_is_prepared_ = false;
    const double rows = problem.row_count();
    if (problem.has_dynamics) {
      sweep_cost_ = 3e-8 * problem.contact_count();
      factor_cost_ = 5e-2 * std::pow(problem.dynamics.dof_count() / 7200.0, 1.5);
    } else {
      sweep_cost_ = 1e-9 * problem.delassus.w.nonZeros() + 2e-8 * problem.contact_count();
      factor_cost_ = 1.5e-9 * rows * rows + 2e-7 * rows;
    }
  }

  void use_threads(int threads) override {
    matrix_sweeps_->use_threads(threads);
    body_sweeps_->use_threads(threads);
    newton_->use_threads(threads);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Rounds rounds(budget, std::move(start));
    sweep_while_it_pays(rounds, problem, budget.tolerance);
    double before = rounds.error();
    int standing_still = 0;
    for (int steps = 40; !rounds.over() && standing_still < patience; steps += steps / 2) {
      if (!newton_is_prepared_) newton_->prepare(problem);
      newton_is_prepared_ = true;
      const int begin = rounds.iterations();
      const double error = rounds.error();
      rounds.run(*newton_, problem, steps);
      if (rounds.over()) break;
      // What misleads Newton is often local, and sweeps mend it. They get twice Newton's time where
      // they are the faster of the two.
      const double newton_cost = (rounds.iterations() - begin) * factor_cost_;
      const double newton_rate = std::log(error / rounds.error()) / newton_cost;
      const double share = newton_rate < sweep_rate_ ? 2.0 : 0.2;
      sweep(*sweeps_, rounds, problem,
            std::clamp(static_cast<int>(share * newton_cost / sweep_cost_), 50, 20000));
      standing_still = rounds.error() < 0.5 * before ? 0 : standing_still + 1;
      if (standing_still == from_elsewhere) {
        const std::unique_ptr<Solver> interior_point = interior_point_maker()();
        interior_point->prepare(problem);
        rounds.run(*interior_point, problem, 2000);
      }
      before = rounds.error();
    }
    return rounds.take();
  }

 private:
  /// A round of sweeps, and what it brought: ln of the error per second of the model.
  void sweep(Solver& solver, Rounds& rounds, const FrictionProblem& problem, int count) {
    const double before = rounds.error();
    rounds.run(solver, problem, count);
    sweep_rate_ = std::log(before / rounds.error()) / (count * sweep_cost_);
  }

  /// Doubling rounds of sweeps, until the rate of the last one promises less than Newton costs:
  /// 20-60 factorisations on stored problems of up to 500 contacts, about a hundred on packings of
  /// 5000.
  void sweep_while_it_pays(Rounds& rounds, const FrictionProblem& problem, double tolerance) {
    rounds.run(*opening_, problem, 8);
    for (int round = 8; !rounds.over(); round *= 2) {
      sweep(*opening_, rounds, problem, round);
      const double needed = tolerance > 0.0 && sweep_rate_ > 0.0
                                ? std::log(rounds.error() / tolerance) / sweep_rate_
                                : 1e300;
      const bool far_away = needed > (20.0 + 0.02 * problem.contact_count()) * factor_cost_;
      const bool fair_share =
          rounds.iterations() * sweep_cost_ > fair_factorisations * factor_cost_;
      if (far_away && fair_share) return;
    }
  }

  /// Rounds of Newton and sweeps without halving the error.
  static constexpr int patience = 60;
  /// After so many of them, an interior point looks for another place to begin.
  static constexpr int from_elsewhere = 4;
  /// Sweeps first, for as long as this many factorisations take.
  static constexpr double fair_factorisations = 2.0;

  std::unique_ptr<Solver> matrix_opening_, matrix_sweeps_, body_sweeps_, newton_;
  Solver* opening_ = nullptr;  ///< the first sweeps: accelerated
  Solver* sweeps_ =
      nullptr;  ///< those between Newton's: acceleration has shown by then that it does not help
  bool newton_is_prepared_ = false;
  double sweep_cost_ = 0.0, factor_cost_ = 0.0;  ///< model [s]
  double sweep_rate_ = 0.0;                      ///< of the last round [1/s]
};

}  // namespace

SolverMaker auto_maker() {
  return []() -> std::unique_ptr<Solver> { return std::make_unique<Auto>(); };
}

}  // namespace ballast
