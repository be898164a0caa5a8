#include "solvers/parts/newton_step.hpp"

#include <limits>
#include <utility>

#include "problems/algebra/root_mean_square.hpp"

namespace ballast {

void NewtonStep::prepare(const FrictionProblem& problem) {
  w_.prepare(problem);
  system_.prepare(w_);
}

void NewtonStep::begin(ContactEquation equation, double rho_factor, Impulses r) {
  equation_ = equation;
  rho_factor_ = rho_factor;
  // An impulse that moves nothing would stay in the answer.
  for (int c = 0; c < w_.contact_count(); ++c)
    if (!(w_.rho()[c] > 0.0)) w_.put(r, c, Eigen::Vector3d::Zero());
  r_ = std::move(r);
  centre_ = r_;
  w_.velocity(r_, u_);
  alpha_.assign(w_.contact_count(), 0.0);
}

void NewtonStep::set_proximal(double weight) {
  for (int c = 0; c < w_.contact_count(); ++c)
    alpha_[c] = w_.rho()[c] > 0.0 ? weight / w_.rho()[c] : 0.0;
}

void NewtonStep::restart(const Impulses& r) {
  r_ = r;
  w_.velocity(r_, u_);
}

/// u + alpha (r - centre): the velocity that the law is asked of. At the centre it is u itself.
Eigen::Vector3d NewtonStep::proximal_velocity(const Impulses& r, const Eigen::VectorXd& u,
                                              int c) const {
  return w_.at(u, c) + alpha_[c] * (w_.at(r, c) - w_.at(centre_, c));
}

double NewtonStep::residual_of(const Impulses& r, const Eigen::VectorXd& u) const {
  RootMeanSquare mean;
  for (int c = 0; c < w_.contact_count(); ++c) {
    if (!(w_.rho()[c] > 0.0)) continue;
    const double rho = rho_factor_ * w_.rho()[c];
    const Eigen::Vector3d missed =
        contact_equation(equation_, w_.at(r, c), proximal_velocity(r, u, c), w_.friction(c), rho);
    mean.add_square(missed.squaredNorm() / (rho * rho));
  }
  return mean.value();
}

bool NewtonStep::newton(int halvings) {
  // The law of every contact, linearised at the iterate with its proximal term.
  linear_.resize(w_.contact_count());
  for (int c = 0; c < w_.contact_count(); ++c) {
    if (w_.rho()[c] > 0.0)
      linear_[c] = linearise(equation_, w_.at(r_, c), proximal_velocity(r_, u_, c), w_.friction(c),
                             rho_factor_ * w_.rho()[c]);
    else  // nothing moves: no impulse
      linear_[c] = {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero()};
  }
  if (!system_.solve(w_, linear_, alpha_, dr_)) return false;
  // Backtracking along the step; u moves with r, as both are linear.
  const double before = residual();
  w_.multiply(dr_, du_);
  // Halved until the residual has fallen by 1e-4 of what the linear model promises; the least
  // one on the way is what is taken.
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
  // Velocities afresh: what the trials have rounded is not kept.
  if (best_t == 0.0) return false;
  r_ += best_t * dr_;
  w_.velocity(r_, u_);
  return best < before;
}

}  // namespace ballast
