#include <algorithm>
#include <limits>
#include <utility>

#include "solvers/backends/backends.hpp"
#include "solvers/parts/newton_system.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// Impulses and the contact velocities that they give, u = W r + q. As u is linear in r, iterates
/// and steps are combined alike.
struct NewtonIterate {
  Impulses r;
  Eigen::VectorXd u;
};

/// Newton's method on the regularised law of all contacts (contact_equation.hpp): every contact's
/// status is guessed from the iterate, and the equations that belong to the statuses are solved
/// exactly.
class RegularNewton {
 public:
  void prepare(const FrictionProblem& problem) {
    w_.prepare(problem);
    system_.prepare(w_);
    gain_.resize(w_.contact_count());
    source_.resize(problem.row_count());
    compliance_.resize(problem.row_count());
    status_.resize(w_.contact_count());
  }
  void use_team(WorkerTeam* team) { system_.use_team(team); }

  /// Moves every impulse into its cone, which a Newton step may leave, and computes u from r
  /// afresh. Returns the judge's error [m/s].
  double settle(NewtonIterate& at) { return w_.project_and_evaluate(at.r, at.u); }

  /// Regularises the law by `epsilon` around `centre` from here on; no status is known.
  void set_centre(const Impulses& centre, double epsilon) {
    centre_ = centre;
    epsilon_ = epsilon;
    for (int c = 0; c < w_.contact_count(); ++c) {
      const double rho = w_.rho()[c];
      w_.put(compliance_, c, Eigen::Vector3d::Constant(rho > 0.0 ? epsilon / rho : 0.0));
    }
    has_status_ = false;
  }

  /// Natural map of the regularised law [m/s], rms over contacts; the law's own error where `at` is
  /// the centre.
  double residual(const NewtonIterate& at) { return w_.error(at.r, regular_velocity(at)); }

  /// Finds every contact's status at `at` and linearises the law for it. Returns how many contacts
  /// had another status when they were last linearised around this centre; 0 the first time. A step
  /// is exact for the statuses that it was made for; where many change it means little.
  int linearise(const NewtonIterate& at) {
    int changed = 0;
    const Eigen::VectorXd& u = regular_velocity(at);
    for (int c = 0; c < w_.contact_count(); ++c) {
      const double rho = w_.rho()[c];
      RegularStep law;
      if (rho > 0.0)
        law = regular_step(w_.friction(c), rho, epsilon_, w_.at(at.r, c), w_.at(u, c));
      else  // no impulse moves it: it gets none
        law.source = -w_.at(at.r, c);
      changed += has_status_ && law.status != status_[c];
      status_[c] = law.status;
      w_.put(source_, c, law.source);
      gain_[c] = law.gain;
    }
    has_status_ = true;
    return changed;
  }

  /// One factorisation: the full step from the point of linearisation. It may raise the residual a
  /// hundredfold where statuses change. False: the matrix is singular or the step not finite.
  bool step(NewtonIterate& change) {
    change.r = source_;
    return system_.solve_springs(gain_, change.r, change.u, /*enough=*/1e-10);
  }

 private:
  /// u + epsilon_c (r - centre); the reference holds until the next call.
  const Eigen::VectorXd& regular_velocity(const NewtonIterate& at) {
    return u_ = at.u + compliance_.cwiseProduct(at.r - centre_);
  }

  ContactOperator w_;
  NewtonSystem system_;
  Impulses centre_, source_;
  Eigen::VectorXd compliance_;  ///< epsilon_c of each row
  Eigen::VectorXd u_;
  double epsilon_ = 1e-3;
  std::vector<Eigen::Matrix3d> gain_;
  std::vector<ContactStatus> status_;
  bool has_status_ = false;
};

/// The compliance epsilon_c in units of lambda_max(W_cc).
constexpr double first_epsilon = 3e-4, smallest_epsilon = 1e-8, largest_epsilon = 0.1;
/// Below this part of the error at zero impulse there are no more bursts.
constexpr double endgame_from = 1e-4;
/// The endgame is patient with up to so many contacts.
constexpr int few_contacts = 1000;

double raised(double epsilon, double factor) { return std::min(largest_epsilon, factor * epsilon); }

class NewtonBurst final : public Solver {
 public:
  explicit NewtonBurst(bool begins_with_sweeps) : begins_with_sweeps_(begins_with_sweeps) {}

  void prepare(const FrictionProblem& problem) override {
    if (!problem.has_dynamics)
      throw UnsupportedProblem(
          "newton_burst: the problem has no dynamics form (M, H): it solves in the bodies' "
          "unknowns");
    sweeps_->prepare(problem);
    is_ready_ = short_walk_.is_prepared = walk_.is_prepared = false;
    problem_ = &problem;
    if (!begins_with_sweeps_) make_ready();
  }

  void use_team(WorkerTeam* team) override {
    sweeps_->use_team(team);
    newton_.use_team(team);
    for (LazySolver* way : {&short_walk_, &walk_}) way->solver->use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Course course(budget, std::move(start));
    if (begins_with_sweeps_) {
      const double step = sweeps_of_step(problem.contact_count());
      course.run(*sweeps_, problem, budget.max_iterations,
                 sweep_stop_rule(step, budget.max_iterations, budget));
    } else {  // the start itself, without impulses that move nothing
      NewtonIterate at{course.best(), {}};
      const double error = newton_.settle(at);
      course.offer(at.r, error);
    }
    if (course.over()) return course.finish();
    make_ready();
    // The error without any impulse gives the scale of the problem's velocities.
    NewtonIterate at{Impulses::Zero(problem.row_count()), {}};
    const double scale = newton_.settle(at), end = endgame_from * scale;
    at.r = course.best();
    double error = newton_.settle(at);
    descend(course, at, error, end);
    endgame(course, at, error);
    // A few steps with plain sweeps and a smaller rho first: where they help, they help at once.
    course.run(short_walk_, problem, short_walk_steps);
    course.run(walk_, problem, most_walk_steps);
    return course.finish();
  }

 private:
  /// How a proximal step's Newton method ended.
  struct Inner {
    bool converged;
    int steps;
  };

  /// Ordering and analysis cost as much as hundreds of sweeps, and most solves do not need them.
  void make_ready() {
    if (is_ready_) return;
    newton_.prepare(*problem_);
    is_ready_ = true;
  }

  /// Does at most `sweeps` accelerated sweeps from `at`. Returns the error there [m/s].
  double burst(Course& course, NewtonIterate& at, int sweeps) {
    Budget budget = course.rest();
    budget.max_iterations = std::min(budget.max_iterations, sweeps);
    budget.keep_history = false;
    Solved swept = sweeps_->solve(*problem_, std::move(at.r), budget);
    at.r = std::move(swept.impulses);
    const double error = newton_.settle(at);
    course.spend(swept.iterations);
    course.offer(at.r, error);
    return error;
  }

  /// Newton steps with a burst after each. A step nearly always raises the error, a hundredfold
  /// where light contacts changed their status; only the error after the sweeps counts. Ends below
  /// the error `end`, or where three rounds in a row gained nothing, or sweeps twice undid a step.
  void descend(Course& course, NewtonIterate& at, double& error, double end) {
    // A burst takes a quarter of a step's time, but no more than statuses need.
    const double quarter = 0.25 * sweeps_of_step(problem_->contact_count());
    const int burst_sweeps = static_cast<int>(std::clamp(quarter, 10.0, 200.0));
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
      course.offer(at.r, after);
      if (course.over()) return;
      NewtonIterate swept = at;
      const double swept_error = burst(course, swept, burst_sweeps);
      const bool is_undone = after < swept_error && after < error;
      if (!(after < swept_error)) {
        after = swept_error;
        at = std::move(swept);
      }
      // Less compliance where a round gained much, more where it lost; a large loss is undone.
      if (after < 0.4 * error) epsilon = std::max(1e-6, 0.5 * epsilon);
      if (after > error) epsilon = raised(epsilon, 4.0);
      slow = after > 0.97 * error ? slow + 1 : 0;
      // Where sweeps undo a step's gain twice in a row, only long waves of the error are left.
      undone = is_undone ? undone + 1 : 0;
      if (after > 2.0 * error && !course.over()) {
        at = before;
        after = burst(course, at, burst_sweeps);
      }
      error = after;
    }
  }

  /// Proximal-point steps by Newton alone: sweeps after a converged step would undo its long waves.
  /// Where steps gain little, as in jams, they drift: each goes on in the last one's direction, as
  /// far as the compliance lets it. go_along() then goes further in less time. Ends where many
  /// steps in a row fail, or gain little for long.
  void endgame(Course& course, NewtonIterate& at, double error) {
    // Patience pays where contacts are few; with many, the walk comes out of jams sooner.
    const bool are_few = problem_->contact_count() <= few_contacts;
    const int most_failures = are_few ? 40 : 4, most_slow_steps = are_few ? 200 : 15;
    double epsilon = first_epsilon, halved = error;
    int failures = 0, slow = 0;
    while (!course.over() && failures < most_failures && slow < most_slow_steps) {
      const NewtonIterate before = at;
      const Inner inner = proximal_step(course, at, error, epsilon);
      const double after = newton_.settle(at);
      course.offer(at.r, after);
      if (inner.converged && after < 1.5 * error) {
        // The easier this step was, the further the next one may go.
        epsilon *= inner.steps <= 2 ? 0.2 : inner.steps <= 3 ? 0.4 : inner.steps <= 5 ? 0.7 : 1.0;
        epsilon = std::max(epsilon, smallest_epsilon);
        failures = 0;
        const bool is_drifting = after > 0.7 * error;
        error = after;
        if (is_drifting && !course.over()) go_along(course, at, before, error, inner.steps);
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

  /// Goes on by twice the step from `before` to `at`, then sweeps to mend the statuses there, for a
  /// third of the time of the step's Newton steps. Kept unless the error grows fourfold.
  void go_along(Course& course, NewtonIterate& at, const NewtonIterate& before, double& error,
                int newton_steps) {
    NewtonIterate ahead = at;
    ahead.r += 2.0 * (at.r - before.r);
    const double sweeps = 0.3 * newton_steps * sweeps_of_step(problem_->contact_count());
    const double there = burst(course, ahead, static_cast<int>(sweeps));
    if (!(there < 4.0 * error)) return;
    at = std::move(ahead);
    error = there;
  }

  /// Newton steps on the law regularised around `at`, until the residual is a third of the error
  /// there. Leaves `at` wherever they ended.
  Inner proximal_step(Course& course, NewtonIterate& at, double error, double epsilon) {
    constexpr double enough = 0.3;
    constexpr int most_steps = 10, most_stalled = 3;
    const int many = problem_->contact_count() / 8;
    newton_.set_centre(at.r, epsilon);
    double residual = error, least = std::numeric_limits<double>::max();
    for (int k = 0, stalled = 0;; ++k) {
      const int changed = newton_.linearise(at);
      if (k > 0) {
        if (residual < enough * error) return {true, k};
        stalled = residual < 0.7 * least ? 0 : stalled + 1;
        least = std::min(least, residual);
      }
      if (k >= most_steps || stalled > most_stalled || (k > 1 && changed > many) || course.over())
        return {false, k};
      course.spend(1);
      if (!newton_.step(change_)) return {false, k};
      // The first step is taken whole: it always raises the residual. Later ones are shortened.
      residual = advance(at, residual, k == 0 ? 1 : 4);
    }
  }

  /// Moves along change_: tries t = 1, 1/2, 1/4, ... until the residual falls by enough, at most
  /// `trials` times, and takes the best. Returns the residual there [m/s].
  double advance(NewtonIterate& at, double before, int trials) {
    double t = 1.0, least = std::numeric_limits<double>::max();
    for (int k = 0; k < trials; ++k, t *= 0.5) {
      trial_.r = at.r + t * change_.r;
      trial_.u = at.u + t * change_.u;
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

  static constexpr int short_walk_steps = 8, most_walk_steps = 1000;  ///< Newton steps
  const bool begins_with_sweeps_;
  std::unique_ptr<Solver> sweeps_ = make_nesterov_pgs(/*returns_best=*/false);
  RegularNewton newton_;
  // Proximal-point steps that may pass through worse iterates, and so come out of jams.
  LazySolver short_walk_{make_proximal_newton({.start_sweeps = 0})};
  LazySolver walk_{make_proximal_newton(
      {.start_sweeps = 0, .accelerated = true, .rho_factors = {100.0, 1000.0, 10.0}})};
  bool is_ready_ = false;  ///< newton_ is prepared for problem_
  const FrictionProblem* problem_ = nullptr;
  NewtonIterate change_, trial_, best_trial_;
};

}  // namespace

std::unique_ptr<Solver> make_newton_burst(bool begins_with_sweeps) {
  return std::make_unique<NewtonBurst>(begins_with_sweeps);
}

}  // namespace ballast
