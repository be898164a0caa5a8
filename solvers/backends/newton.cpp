#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "problems/algebra/friction_cone.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/parts/newton_system.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

/// The iterate (r, u = W r + q) of a Newton method. The residual is that of F(r, u + alpha (r -
/// centre)) = 0.
class NewtonStep {
 public:
  void prepare(const FrictionProblem& problem) {
    w_.prepare(problem);
    system_.prepare(w_);
  }
  void use_team(WorkerTeam* team) { system_.use_team(team); }

  /// Starts at `r`, which is also the centre. Contacts that no impulse moves lose theirs, which
  /// would stay in the answer.
  void begin(ContactEquation equation, double rho_factor, const Impulses& r) {
    equation_ = equation;
    rho_factor_ = rho_factor;
    r_ = r;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (!(w_.rho()[c] > 0.0)) w_.put(r_, c, Eigen::Vector3d::Zero());
    centre_ = r_;
    w_.velocity(r_, u_);
    alpha_.assign(w_.contact_count(), 0.0);
  }

  void set_rho_factor(double factor) { rho_factor_ = factor; }
  /// alpha_c = weight / rho_c
  void set_proximal(double weight) {
    for (int c = 0; c < w_.contact_count(); ++c)
      alpha_[c] = w_.rho()[c] > 0.0 ? weight / w_.rho()[c] : 0.0;
  }
  /// Moves the centre to the iterate.
  void centre() { centre_ = r_; }
  /// Moves the iterate (back) to `r`.
  void restart(const Impulses& r) {
    r_ = r;
    w_.velocity(r_, u_);
  }

  /// One factorisation and a backtracking line search on residual(). False: singular, or no
  /// descent. A step without descent is still taken where it raises the residual by less than a
  /// tenth, so that flat places can be left; with `halvings` = 0 it is taken whole in any case.
  bool newton(int halvings) {
    linear_.resize(w_.contact_count());
    for (int c = 0; c < w_.contact_count(); ++c) {
      if (!(w_.rho()[c] > 0.0)) {  // no impulse moves it: dr = 0
        linear_[c] = {};
        continue;
      }
      linear_[c] = linearise(equation_, w_.at(r_, c), proximal_velocity(r_, u_, c), w_.friction(c),
                             rho_factor_ * w_.rho()[c]);
      linear_[c].df_dr += alpha_[c] * linear_[c].df_du;  // the proximal velocity moves with r
    }
    if (!system_.solve(linear_, dr_)) return false;
    // Backtracking along the step; u moves with r, as both are linear.
    const double before = residual();
    w_.multiply(dr_, du_);
    // Halves the step until the residual has fallen by 1e-4 of the linear model's promise, and
    // takes the trial with the least residual.
    double t = 1.0, best_t = 0.0,
           best = halvings > 0 ? before * 1.1 : std::numeric_limits<double>::max();
    for (int k = 0; k <= halvings; ++k, t *= 0.5) {
      r_trial_ = r_ + t * dr_;
      u_trial_ = u_ + t * du_;
      const double residual_there = residual_of(r_trial_, u_trial_);
      if (residual_there < best) {
        best = residual_there;
        best_t = t;
      }
      if (residual_there <= (1.0 - 1e-4 * t) * before) break;
    }
    if (best_t == 0.0) return false;
    // Computes the velocities afresh, without the rounding of the trials.
    r_ += best_t * dr_;
    w_.velocity(r_, u_);
    return best < before;
  }

  /// rms over contacts of |F_c| / rho_c [m/s].
  double residual() const { return residual_of(r_, u_); }
  /// The judge's error of the iterate [m/s].
  double error() const { return w_.error(r_, u_); }
  const Impulses& impulses() const { return r_; }

 private:
  /// u + alpha (r - centre): the velocity in the proximal law. At the centre it is u itself.
  Eigen::Vector3d proximal_velocity(const Impulses& r, const Eigen::VectorXd& u, int c) const {
    return w_.at(u, c) + alpha_[c] * (w_.at(r, c) - w_.at(centre_, c));
  }

  double residual_of(const Impulses& r, const Eigen::VectorXd& u) const {
    RootMeanSquare mean;
    for (int c = 0; c < w_.contact_count(); ++c) {
      if (!(w_.rho()[c] > 0.0)) continue;
      const double rho = rho_factor_ * w_.rho()[c];
      const Eigen::Vector3d missed =
          linearise(equation_, w_.at(r, c), proximal_velocity(r, u, c), w_.friction(c), rho).f;
      mean.add_square(missed.squaredNorm() / (rho * rho));
    }
    return mean.value();
  }

  ContactOperator w_;
  NewtonSystem system_;
  ContactEquation equation_ = ContactEquation::alart_curnier;
  double rho_factor_ = 1.0;
  std::vector<double> alpha_;
  std::vector<ContactLinearisation> linear_;
  Impulses r_, centre_, dr_, r_trial_;
  Eigen::VectorXd u_, du_, u_trial_;
};

/// Whether nothing is left to do for a method that looks at the error after every step.
bool is_over(const Course& course) {
  return course.over() || course.idle() >= Iteration::stalled_after;
}

class Newton final : public Solver {
 public:
  explicit Newton(ContactEquation equation) : equation_(equation) {}

  void prepare(const FrictionProblem& problem) override { step_.prepare(problem); }
  void use_team(WorkerTeam* team) override { step_.use_team(team); }

  Solved solve(const FrictionProblem&, Impulses start, const Budget& budget) override {
    Course course(budget, std::move(start));
    step_.begin(equation_, 1.0, course.best());
    step_.set_proximal(smallest_weight);
    course.offer(step_.impulses(), step_.error());
    double weight = smallest_weight;
    for (int failures = 0; !is_over(course) && failures < most_failures;) {
      course.spend(1);
      const double before = step_.residual();
      // where no shorter step descends, the whole one may leave the kink
      failures = step_.newton(failures % 2 ? 0 : most_halvings) ? 0 : failures + 1;
      step_.centre();
      course.offer(step_.impulses(), step_.error());
      // Less of the proximal term where Newton converges, more where it does not.
      if (step_.residual() < 0.5 * before)
        weight = std::max(smallest_weight, 0.1 * weight);
      else if (failures > 0)
        weight = std::min(largest_weight, 10.0 * weight);
      step_.set_proximal(weight);
    }
    Solved solved = course.finish();
    solved.own_residual = step_.residual();
    return solved;
  }

 private:
  /// alpha rho where no proximal term is wanted: the elimination in velocity space needs a regular
  /// contact block. Where W is singular, 1 / weight times the rounding of u, about 1e-16 |q|, comes
  /// into r: a step without descent is taken for a sign of that, and the weight grows.
  static constexpr double smallest_weight = 1e-7, largest_weight = 1e-3;
  static constexpr int most_halvings = 12;  ///< of a step
  static constexpr int most_failures = 8;   ///< in a row
  ContactEquation equation_;
  NewtonStep step_;
};

class ProximalNewton final : public Solver {
 public:
  explicit ProximalNewton(const ProximalNewtonSettings& settings)
      : settings_(settings),
        sweeps_(settings.accelerated ? make_nesterov_pgs(/*returns_best=*/false)
                                     : make_gauss_seidel()) {}

  void prepare(const FrictionProblem& problem) override {
    sweeps_->prepare(problem);
    step_.prepare(problem);
  }
  void use_team(WorkerTeam* team) override {
    sweeps_->use_team(team);
    step_.use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Course course(budget, std::move(start));
    step_.begin(ContactEquation::alart_curnier, settings_.rho_factors[0], course.best());
    course.offer(step_.impulses(), step_.error());
    // Even a warm start is swept first: Newton converges from near by only, and hundreds of
    // contacts of a warm start have another status in this problem.
    if (budget.max_iterations > 0 && settings_.start_sweeps > 0)
      sweep(problem, settings_.start_sweeps, course);
    double weight = settings_.first_weight, halved = course.error();
    int failures = 0, halved_at = 0;
    while (failures < 30 && course.count() - halved_at <= patience * budget.max_iterations) {
      const int steps = proximal_step(weight, course);
      if (steps < 0) break;  // the course is over
      // Patience counts from the last time that the best error was halved.
      if (course.error() < 0.5 * halved) {
        halved = course.error();
        halved_at = course.count();
      }
      // An easy step lowers alpha; a failed one raises it and tries another rho.
      if (steps > 0 && steps <= inner_steps) {
        failures = 0;
        if (steps <= inner_steps / 2) weight = std::max(1e-9, weight * 0.3);
      } else {
        ++failures;
        weight = std::min(1e3, weight * 4.0);
        step_.set_rho_factor(settings_.rho_factors[failures % 3]);
        // sweeps mend locally the contacts that misled Newton: they opened or began to slip
        sweep(problem, settings_.mending_sweeps, course);
      }
    }
    Solved solved = course.finish();
    solved.own_residual = step_.residual();
    return solved;
  }

 private:
  /// Does `count` sweeps from the iterate; they do not count as iterations.
  void sweep(const FrictionProblem& problem, int count, Course& course) {
    Budget budget = course.rest();
    budget.max_iterations = count;
    budget.keep_history = false;
    step_.restart(sweeps_->solve(problem, step_.impulses(), budget).impulses);
    course.offer(step_.impulses(), step_.error());
  }

  /// One proximal step from the current iterate. Returns the number of Newton steps; inner_steps +
  /// 1 where it failed, with the iterate back where the step began; -1 where the course is over.
  int proximal_step(double weight, Course& course) {
    // The centre is the current iterate. The inner Newton has to reduce the residual that the law
    // itself has there.
    step_.centre();
    step_.set_proximal(0.0);
    const double begin = step_.residual();
    step_.set_proximal(weight);
    const Impulses centre = step_.impulses();
    for (int k = 1; k <= inner_steps; ++k) {
      if (is_over(course)) return -1;
      course.spend(1);
      const bool descended = step_.newton(8);
      course.offer(step_.impulses(), step_.error());
      if (step_.residual() <= inner_reduction * begin) return k;
      if (!descended) break;
    }
    step_.restart(centre);
    return inner_steps + 1;
  }

  /// The part of the residual that an inner Newton must reach.
  static constexpr double inner_reduction = 0.5;
  static constexpr int inner_steps = 12;  ///< after which a proximal step has failed
  /// Part of the budget's iterations without halving the error, after which it gives up.
  static constexpr double patience = 0.375;
  ProximalNewtonSettings settings_;
  std::unique_ptr<Solver> sweeps_;
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
