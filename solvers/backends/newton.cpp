#include "solvers/backends/newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/parts/newton_step.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// The best iterate so far, by the judge's error.
struct Best {
  Impulses r;
  double error;
  void offer(const Impulses& candidate, double candidate_error) {
    if (!(candidate_error < error)) return;
    r = candidate;
    error = candidate_error;
  }
};

class Newton final : public Solver {
 public:
  explicit Newton(ContactEquation equation) : equation_(equation) {}

  void prepare(const FrictionProblem& problem) override { step_.prepare(problem); }
  void use_team(WorkerTeam* team) override { step_.use_team(team); }

  Solved solve(const FrictionProblem&, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.0});
    step_.begin(equation_, 1.0, std::move(r));
    step_.set_proximal(smallest_weight);
    Best best{step_.impulses(), step_.error()};
    iteration.evaluated(best.error, best.r);
    int failures = 0;
    double weight = smallest_weight;
    while (iteration.next()) {
      const double before = step_.residual();
      // where no shorter step descends, the whole one may leave the kink
      failures = step_.newton(failures % 2 ? 0 : most_halvings) ? 0 : failures + 1;
      step_.centre();
      best.offer(step_.impulses(), step_.error());
      iteration.evaluated(best.error, best.r);
      if (failures >= 8) break;
      // Less of the proximal term where Newton converges, more where it does not.
      if (step_.residual() < 0.5 * before)
        weight = std::max(smallest_weight, 0.1 * weight);
      else if (failures > 0)
        weight = std::min(largest_weight, 10.0 * weight);
      step_.set_proximal(weight);
    }
    Solved solved = iteration.finish(std::move(best.r));
    if (failures >= 8 && solved.reason != StopReason::reached_tolerance)
      solved.reason = StopReason::stalled;
    solved.own_residual = step_.residual();
    return solved;
  }

 private:
  /// alpha rho where none is wanted: velocity-space elimination needs a regular contact block.
  /// Where W is singular, 1 / weight times the rounding of u, about 1e-16 |q|, comes into r: a step
  /// without descent is taken for that and the weight grows.
  static constexpr double smallest_weight = 1e-7, largest_weight = 1e-3;
  static constexpr int most_halvings = 12;  ///< of a step
  ContactEquation equation_;
  NewtonStep step_;
};

class ProximalNewton final : public Solver {
 public:
  explicit ProximalNewton(const ProximalNewtonSettings& settings)
      : settings_(settings),
        start_(settings.accelerated ? make_nesterov_pgs({.returns_best = false})
                                    : make_gauss_seidel()) {}

  void prepare(const FrictionProblem& problem) override {
    start_->prepare(problem);
    step_.prepare(problem);
  }
  void use_team(WorkerTeam* team) override {
    start_->use_team(team);
    step_.use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.0});
    step_.begin(ContactEquation::alart_curnier, settings_.rho_factors[0], std::move(r));
    Best best{step_.impulses(), step_.error()};
    // The start is swept first, a warm one too: Newton converges from near by only, and of a warm
    // start hundreds of contacts have another status by now.
    if (budget.max_iterations > 0 && settings_.start_sweeps > 0) {
      step_.restart(
          swept(problem, step_.impulses(), settings_.start_sweeps, budget.max_seconds, budget));
      best.offer(step_.impulses(), step_.error());
    }
    iteration.evaluated(best.error, best.r);
    double weight = settings_.first_weight, halved = best.error;
    int failures = 0, halved_at = 0;
    while (failures < 30 && iteration.count() - halved_at <= patience * budget.max_iterations) {
      const int steps = proximal_step(iteration, weight, best);
      if (steps < 0) break;  // the budget ended
      // Patience counts from the last time that the best error was halved.
      if (best.error < 0.5 * halved) {
        halved = best.error;
        halved_at = iteration.count();
      }
      // An easy step lowers alpha; a failed one raises it and tries another rho.
      if (steps > 0 && steps <= inner_steps) {
        failures = 0;
        if (steps <= inner_steps / 2) weight = std::max(1e-9, weight * 0.3);
      } else {
        ++failures;
        weight = std::min(1e3, weight * 4.0);
        step_.set_rho_factor(settings_.rho_factors[failures % 3]);
        // sweeps mend locally what misled Newton: contacts that opened or began to slip
        step_.restart(swept(problem, step_.impulses(), settings_.mending_sweeps,
                            budget.max_seconds - iteration.seconds(), budget));
        best.offer(step_.impulses(), step_.error());
      }
    }
    Solved solved = iteration.finish(std::move(best.r));
    if (solved.reason == StopReason::numerical_failure) solved.reason = StopReason::stalled;
    solved.own_residual = step_.residual();
    return solved;
  }

 private:
  Impulses swept(const FrictionProblem& problem, Impulses r, int count, double seconds,
                 const Budget& budget) {
    const Budget sweeps{.tolerance = budget.tolerance,
                        .max_iterations = count,
                        .max_seconds = std::max(0.0, seconds),
                        .fclib = budget.fclib};
    return start_->solve(problem, std::move(r), sweeps).impulses;
  }

  /// One proximal step from the current iterate. Newton steps taken; one more than allowed: failed,
  /// and the iterate is where the step began; -1: the budget ended.
  int proximal_step(Iteration& iteration, double weight, Best& best) {
    // The centre is here. The inner Newton has to reduce the residual of the law itself at this
    // point.
    step_.centre();
    step_.set_proximal(0.0);
    const double begin = step_.residual();
    step_.set_proximal(weight);
    const Impulses centre = step_.impulses();
    for (int k = 1; k <= inner_steps; ++k) {
      if (!iteration.next()) return -1;
      const bool descended = step_.newton(8);
      best.offer(step_.impulses(), step_.error());
      iteration.evaluated(best.error, best.r);
      if (step_.residual() <= inner_reduction * begin) return k;
      if (!descended) break;
    }
    step_.restart(centre);
    return inner_steps + 1;
  }

  /// Of the residual, that an inner Newton must reach.
  static constexpr double inner_reduction = 0.5;
  static constexpr int inner_steps = 12;  ///< after which a proximal step has failed
  /// Part of the budget's iterations without halving the error, after which it gives up.
  static constexpr double patience = 0.375;
  ProximalNewtonSettings settings_;
  std::unique_ptr<Solver> start_;
  NewtonStep step_;
};

}  // namespace

std::unique_ptr<Solver> make_newton(ContactEquation equation) {
  return std::make_unique<Newton>(equation);
}

std::unique_ptr<Solver> make_proximal_newton(const ProximalNewtonSettings& settings) {
  return std::make_unique<ProximalNewton>(settings);
}

}  // namespace ballast
