#include <cmath>
#include <utility>

#include "solvers/backends/backends.hpp"
#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

// With u(r) = W r + q linear, the velocities at the extrapolated point are the same combination of
// those at the iterates:
//   r+ = P_K(y - t rho (u_y + s n)),   y+ = r+ + beta (r+ - r),   u_y+ = u+ + beta (u+ - u)
class Apgd final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    const int rows = problem.row_count();
    for (Eigen::VectorXd* x : {&u_, &y_, &uy_, &next_, &next_u_, &moved_}) x->resize(rows);
    first_step_ = gradient_step(rows);
  }

  Solved solve(const FrictionProblem&, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.02});
    iteration.evaluated(w_.project_and_evaluate(r, u_), r);
    shift_.reset(w_);
    shift_.follow(w_, u_);
    step_ = first_step_;
    restart(r);
    while (iteration.next()) {
      descend();
      if (!short_enough()) {
        step_ *= 0.6;
      } else {
        accept(r);
        if (iteration.count() % shift_every == 0) shift_.follow(w_, u_);
        step_ *= 1.02;
      }
      if (iteration.is_error_due()) iteration.evaluated(w_.error(r, u_), r);
    }
    return iteration.finish(std::move(r));
  }

 private:
  /// The step of a projected gradient along rho_c u_c: 1 / lambda_max(D^-1 W) with D_c = I / rho_c.
  /// lambda_max comes from 30 products of a power iteration with a fixed start, which end some per
  /// cent below it. Returns 1 where W is zero.
  double gradient_step(int rows) {
    const auto divide = [this](Eigen::VectorXd& x) {
      for (int c = 0; c < w_.contact_count(); ++c) w_.put(x, c, w_.rho()[c] * w_.at(x, c));
    };
    Eigen::VectorXd x(rows), y(rows);
    for (int i = 0; i < rows; ++i)
      x[i] = 1.0 + 0.5 * ((i * 7919) % 17) / 17.0 - (i % 3 == 1 ? 2.0 : 0.0);
    divide(x);
    double lambda = 0.0;
    for (int k = 0; k < 30; ++k) {
      const double norm = x.norm();
      if (!(norm > 0.0)) break;
      x /= norm;
      w_.multiply(x, y);
      divide(y);
      lambda = y.norm();
      x.swap(y);
    }
    return lambda > 0.0 ? 1.0 / lambda : 1.0;
  }

  /// sum_c x_c . y_c / rho_c over the contacts that move: the product in which W's diagonal is
  /// about one.
  double scaled_dot(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const {
    double sum = 0.0;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (w_.rho()[c] > 0.0) sum += w_.at(x, c).dot(w_.at(y, c)) / w_.rho()[c];
    return sum;
  }

  /// Restarts Nesterov's momentum: the extrapolated point is the iterate.
  void restart(const Impulses& r) {
    theta_ = 1.0;
    y_ = r;
    uy_ = u_;
  }

  /// A projected gradient step from the extrapolated point y.
  void descend() {
    for (int c = 0; c < w_.contact_count(); ++c)
      w_.put(next_, c, w_.at(y_, c) - step_ * w_.rho()[c] * shift_.shifted(w_, uy_, c));
    w_.project(next_);
    w_.velocity(next_, next_u_);
    moved_ = next_ - y_;
  }

  /// d.W d <= |d|^2 / t: the model that the step has minimised lies above the energy.
  bool short_enough() const {
    const double curvature = moved_.dot(next_u_ - uy_);
    return curvature * step_ <= (1.0 + 1e-10) * scaled_dot(moved_, moved_) ||
           step_ < 1e-3 * first_step_;
  }

  /// Accepts the step: extrapolates, or restarts where the momentum went against the gradient.
  void accept(Impulses& r) {
    const Eigen::VectorXd& gone = (y_ = next_ - r);  // y is no longer needed
    const bool uphill = scaled_dot(moved_, gone) < 0.0;
    // Nesterov's sequence: theta+^2 = (1 - theta+) theta^2, beta = theta (1
    // - theta) / (theta^2 + theta+).
    const double next_theta =
        0.5 * (std::sqrt(theta_ * theta_ * (theta_ * theta_ + 4.0)) - theta_ * theta_);
    const double beta = theta_ * (1.0 - theta_) / (theta_ * theta_ + next_theta);
    uy_ = next_u_ - u_;
    r.swap(next_);
    u_.swap(next_u_);
    if (uphill) return restart(r);
    theta_ = next_theta;
    y_ = r + beta * gone;
    uy_ = u_ + beta * uy_;
  }

  static constexpr int shift_every = 5;  ///< iterations between s-updates

  ContactOperator w_;
  SlipShift shift_;
  Eigen::VectorXd u_, y_, uy_, next_, next_u_, moved_;
  double first_step_ = 1.0, step_ = 1.0, theta_ = 1.0;
};

}  // namespace

std::unique_ptr<Solver> make_apgd() { return std::make_unique<Apgd>(); }

}  // namespace ballast
