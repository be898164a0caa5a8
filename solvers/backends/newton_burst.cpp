#include "solvers/backends/newton_burst.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/parts/regular_newton.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// The compliance, as a part of lambda_max(W_cc).
constexpr double first_epsilon = 3e-4, smallest_epsilon = 1e-8, largest_epsilon = 0.1;
/// Below this part of the error at zero impulse there are no more bursts.
constexpr double endgame_from = 1e-4;

double raised(double epsilon, double factor) { return std::min(largest_epsilon, factor * epsilon); }

class NewtonBurst final : public Solver {
 public:
  explicit NewtonBurst(const NewtonBurstSettings& settings)
      : settings_(settings),
        sweeps_(make_nesterov_pgs({.returns_best = false})),
        walk_(make_proximal_newton(
            {.start_sweeps = 0, .accelerated = true, .rho_factors = {100.0, 1000.0, 10.0}})) {}

  void prepare(const FrictionProblem& problem) override {
    if (!problem.has_dynamics)
      throw UnsupportedProblem(
          "newton_burst: the problem has no dynamics form (M, H): it solves in the bodies' "
          "unknowns");
    sweeps_->prepare(problem);
    is_ready_ = false;
    problem_ = &problem;
    if (settings_.start_sweeps == 0) make_ready();
  }

  void use_team(WorkerTeam* team) override {
    sweeps_->use_team(team);
    newton_.use_team(team);
    walk_->use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    problem_ = &problem;
    Course course(budget, std::move(start));
    if (settings_.start_sweeps > 0)
      course.run([&](Impulses first, Budget whole) {
        whole.gives_up = slow_sweeps(settings_.start_sweeps, settings_.promised_sweeps, budget);
        return sweeps_->solve(problem, std::move(first), whole);
      });
    else
      offer_start(course);
    return by_newton(course);
  }

 private:
  /// From where the course has come to, if it is not over.
  Solved by_newton(Course& course) {
    if (course.over()) return course.finish();
    make_ready();
    // The error without any impulse says how large the problem's velocities are.
    NewtonIterate at = newton_.iterate(Impulses::Zero(problem_->row_count()));
    const double scale = newton_.settle(at), end = endgame_from * scale;
    at = newton_.iterate(course.best());
    double error = newton_.settle(at);
    descend(course, at, error, end);
    if (course.over()) return course.finish();
    endgame(course, at, error);
    if (course.over()) return course.finish();
    walk_->prepare(*problem_);
    course.run(*walk_, *problem_, settings_.most_steps);
    return course.finish();
  }

  /// The start itself, without impulses that move nothing.
  void offer_start(Course& course) {
    NewtonIterate at = newton_.iterate(course.best());
    offer(course, at, newton_.settle(at));
  }

  /// How a proximal step's Newton method ended.
  struct Inner {
    bool converged;
    int steps;
  };

  /// Ordering and analysis cost as much as hundreds of sweeps, and most solves do without.
  void make_ready() {
    if (is_ready_) return;
    newton_.prepare(*problem_);
    is_ready_ = true;
  }

  void offer(Course& course, const NewtonIterate& at, double error) {
    newton_.contacts().to_impulses(at.r, impulses_);
    course.offer(impulses_, error);
  }

  /// Accelerated sweeps from `at`, at most so many. Returns the error there [m/s].
  double burst(Course& course, NewtonIterate& at, int sweeps) {
    Budget budget = course.rest();
    budget.max_iterations = std::min(budget.max_iterations, sweeps);
    budget.keep_history = false;
    newton_.contacts().to_impulses(at.r, impulses_);
    Solved swept = sweeps_->solve(*problem_, std::move(impulses_), budget);
    impulses_ = std::move(swept.impulses);
    at = newton_.iterate(impulses_);
    const double error = newton_.settle(at);
    course.spend(swept.iterations);
    course.offer(impulses_, error);
    return error;
  }

  /// Newton steps with a burst after each. A step nearly always raises the error, a hundredfold
  /// where light contacts changed their status; what counts is where the sweeps after it end. Ends
  /// below the error `end`, or where three rounds in a row gained nothing.
  void descend(Course& course, NewtonIterate& at, double& error, double end) {
    double epsilon = first_epsilon;
    int slow = 0, undone = 0;
    while (!course.over() && error > end && slow < 3 && undone < 2) {
      const NewtonIterate before = at;
      newton_.set_centre(at.r, epsilon);
      newton_.linearise(at);
      course.spend(1);
      if (!newton_.step(change_)) {
        epsilon = raised(epsilon, 4.0);
        ++slow;
        continue;
      }
      at.r += change_.r;
      double after = newton_.settle(at);
      offer(course, at, after);
      if (course.over()) return;
      NewtonIterate swept = at;
      const double swept_error = burst(course, swept, settings_.burst);
      const bool is_undone = after < swept_error && after < error;
      if (!(after < swept_error)) {
        after = swept_error;
        at = std::move(swept);
      }
      // Less compliance where a round gained much, more where it lost; back where it lost much.
      if (after < 0.4 * error) epsilon = std::max(1e-6, 0.5 * epsilon);
      if (after > error) epsilon = raised(epsilon, 4.0);
      slow = after > 0.97 * error ? slow + 1 : 0;
      // Twice in a row sweeps undid what the step had gained: what is left are long waves.
      undone = is_undone ? undone + 1 : 0;
      if (after > 2.0 * error && !course.over()) {
        at = before;
        after = burst(course, at, settings_.burst);
      }
      error = after;
    }
  }

  /// Proximal-point steps by Newton alone: sweeps after a converged step would undo its long waves.
  /// Ends where steps fail one after the other, gain little for long, or have taken their part.
  void endgame(Course& course, NewtonIterate& at, double& error) {
    constexpr int most_failures = 4, most_slow_steps = 15;
    double epsilon = first_epsilon, halved = error;
    int failures = 0, slow = 0, steps = 0;
    while (!course.over() && failures < most_failures && slow < most_slow_steps &&
           steps < settings_.descent_steps) {
      const NewtonIterate before = at;
      const Inner inner = proximal_step(course, at, error, epsilon);
      steps += inner.steps;
      const double after = newton_.settle(at);
      offer(course, at, after);
      if (inner.converged && after < 1.5 * error) {
        // The next step may go further, the easier this one was.
        epsilon *= inner.steps <= 2 ? 0.2 : inner.steps <= 3 ? 0.4 : inner.steps <= 5 ? 0.7 : 1.0;
        epsilon = std::max(epsilon, smallest_epsilon);
        failures = 0;
        error = after;
      } else if (after < 0.9 * error) {
        epsilon = raised(epsilon, 2.0);
        error = after;
      } else {
        epsilon = raised(epsilon, 3.0);
        at = before;
        ++failures;
      }
      ++slow;
      if (error > 0.5 * halved) continue;
      halved = error;
      slow = 0;
    }
  }

  /// Newton steps on the law regularised around `at`, until the residual is a third of the error
  /// there. `at` is left wherever they ended.
  Inner proximal_step(Course& course, NewtonIterate& at, double error, double epsilon) {
    constexpr double enough = 0.3;
    constexpr int most_stalled = 3;
    const int many = newton_.contacts().contact_count() / 8;
    newton_.set_centre(at.r, epsilon);
    double residual = error, least = std::numeric_limits<double>::max();
    for (int k = 0, stalled = 0;; ++k) {
      const int changed = newton_.linearise(at);
      if (k > 0) {
        if (residual < enough * error) return {true, k};
        stalled = residual < 0.7 * least ? 0 : stalled + 1;
        least = std::min(least, residual);
      }
      if (k >= settings_.inner_steps || stalled > most_stalled || (k > 1 && changed > many) ||
          course.over())
        return {false, k};
      course.spend(1);
      if (!newton_.step(change_)) return {false, k};
      // The first step is taken whole: it always raises the residual. Later ones are shortened.
      residual = advance(at, residual, k == 0 ? 1 : 4);
    }
  }

  /// Along change_: t = 1, 1/2, 1/4, ... until the residual falls by enough, at most so many
  /// trials; then the best of them. Returns the residual there [m/s].
  double advance(NewtonIterate& at, double before, int trials) {
    double t = 1.0, least = std::numeric_limits<double>::max();
    for (int k = 0; k < trials; ++k, t *= 0.5) {
      trial_.r = at.r + t * change_.r;
      trial_.x = at.x + t * change_.x;
      const double there = newton_.residual(trial_);
      if (k == 0 || there < least) {
        least = there;
        std::swap(best_trial_, trial_);
      }
      if (there < (1.0 - 0.3 * t) * before) break;
    }
    std::swap(at, best_trial_);
    return least;
  }

  NewtonBurstSettings settings_;
  std::unique_ptr<Solver> sweeps_;
  RegularNewton newton_;
  std::unique_ptr<Solver> walk_;  ///< proximal-point steps that may go through worse places
  bool is_ready_ = false;         ///< newton_ is prepared for problem_
  const FrictionProblem* problem_ = nullptr;
  NewtonIterate change_, trial_, best_trial_;
  Impulses impulses_;
};

}  // namespace

std::unique_ptr<Solver> make_newton_burst(const NewtonBurstSettings& settings) {
  return std::make_unique<NewtonBurst>(settings);
}

}  // namespace ballast
