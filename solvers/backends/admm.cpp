#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/backends/backends.hpp"
#include "solvers/parts/shifted_delassus.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

// min 1/2 x.W x + x.(q + s n)  s.t.  x = r, r in K;  multiplier y, penalty P = beta
// lambda_max(W_cc):
//   x  = (W + P)^-1 (P r - y - q - s n)
//   x^ = a x + (1 - a) r
//   r  = P_K(x^ + P^-1 y),   y += P (x^ - r)
// At a fixed point y = -(u + s n). Only r, which lies in the cones, is judged or returned.
class Admm final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    system_.prepare(w_);
    free_contact_velocity(problem, q_);
    for (Eigen::VectorXd* x : {&u_, &x_, &y_, &right_}) x->resize(problem.row_count());
    factored_ = set_penalty(first_penalty);
  }

  void use_team(WorkerTeam* team) override { system_.use_team(team); }

  Solved solve(const FrictionProblem&, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.0});
    iteration.evaluated(w_.project_and_evaluate(r, u_), r);
    shift_.reset(w_);
    shift_.follow(w_, u_);
    for (int c = 0; c < w_.contact_count(); ++c) w_.put(y_, c, -shift_.shifted(w_, u_, c));
    if (penalty_ != first_penalty) factored_ = set_penalty(first_penalty);
    next_look_ = look_after_ = adapt_every;
    while (iteration.next()) {
      if (!factored_) {
        iteration.evaluated(std::numeric_limits<double>::quiet_NaN(), r);
        break;
      }
      alternate(r);
      w_.velocity(r, u_);
      // Updates s, and the multiplier that goes with it. s follows the multiplier's own u_T, which
      // changes gently: with the velocity that r gives the iteration may circle.
      shift_multiplier(+1.0);
      shift_.follow(w_, y_);
      shift_multiplier(-1.0);
      if (iteration.count() >= next_look_) adapt(iteration.count());
      if (iteration.is_error_due()) iteration.evaluated(w_.error(r, u_), r);
    }
    return iteration.finish(std::move(r));
  }

 private:
  /// Sets P for every contact and factors once: the factorisation serves until P changes.
  bool set_penalty(double penalty) {
    penalty_ = penalty;
    for (int c = 0; c < w_.contact_count(); ++c) {
      const double rho =
          w_.rho()[c] > 0.0 ? w_.rho()[c] : 1.0;  // where no impulse moves it, any value will do
      system_.sigma[c] = rho / penalty * Eigen::Matrix3d::Identity();
      system_.shift[c] = 1.0 / sigma(c) * Eigen::Matrix3d::Identity();
    }
    return system_.factor();
  }

  double sigma(int c) const { return system_.sigma[c](0, 0); }  ///< P^-1

  /// One iteration of the formulas above; measures how much x and r differ and how far r moved.
  void alternate(Impulses& r) {
    for (int c = 0; c < w_.contact_count(); ++c) {
      Eigen::Vector3d b = w_.at(r, c) / sigma(c) - w_.at(y_, c) - w_.at(q_, c);
      b[0] -= shift_[c];
      w_.put(right_, c, b);
    }
    system_.solve(right_, x_);
    split_ = moved_ = 0.0;
    for (int c = 0; c < w_.contact_count(); ++c) {
      if (!(w_.rho()[c] > 0.0)) continue;
      const double lambda_max = 1.0 / w_.rho()[c];
      const Eigen::Vector3d before = w_.at(r, c), x = w_.at(x_, c), y = w_.at(y_, c);
      // a > 1 goes beyond x (over-relaxation).
      const Eigen::Vector3d relaxed = before + relaxation * (x - before);
      const Eigen::Vector3d after = project_cone(relaxed + sigma(c) * y, w_.friction(c));
      w_.put(r, c, after);
      w_.put(y_, c, y + (relaxed - after) / sigma(c));
      split_ += (x - after).squaredNorm() * lambda_max * lambda_max;
      moved_ += (after - before).squaredNorm() / (sigma(c) * sigma(c));
    }
  }

  void shift_multiplier(double sign) {
    for (int c = 0; c < w_.contact_count(); ++c) y_[w_.problem().row_begin[c]] += sign * shift_[c];
  }

  /// Balances the two residuals, both velocities: the difference of x and r, and the change of r
  /// (Boyd et al. 2011, 3.4.1).
  void adapt(int count) {
    next_look_ = count + look_after_;
    // Looks become rarer: each new penalty costs a factorisation and throws the iteration back.
    look_after_ += look_after_ / 5;
    if (!(split_ > 0.0 && moved_ > 0.0)) return;
    // split_ and moved_ are squares: the root of the ratio of their norms is half the
    // way to balance, in logarithms.
    const double factor = std::clamp(std::pow(split_ / moved_, 0.25), 0.01, 100.0);
    if (factor > adapt_from || factor < 1.0 / adapt_from)
      factored_ = set_penalty(std::clamp(penalty_ * factor, 1e-6, 1e6));
  }

  static constexpr double relaxation = 1.6;
  static constexpr double first_penalty = 0.1;  ///< in units of lambda_max(W_cc)
  /// Iterations between looks at the penalty; each interval is a fifth longer, so that it settles.
  static constexpr int adapt_every = 20;
  /// A penalty is changed by no less than this factor: each change costs a factorisation.
  static constexpr double adapt_from = 3.0;

  ContactOperator w_;
  ShiftedDelassus system_;
  SlipShift shift_;
  Eigen::VectorXd q_, u_, x_, y_, right_;
  double penalty_ = 1.0, split_ = 0.0, moved_ = 0.0;  ///< split_, moved_: squares
  int next_look_ = 0, look_after_ = 0;
  bool factored_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_admm() { return std::make_unique<Admm>(); }

}  // namespace ballast
