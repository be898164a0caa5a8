#include "solvers/backends/apgd.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

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
    first_step_ = gradient_step(w_);
    const int rows = problem.row_count();
    for (Eigen::VectorXd* x : {&u_, &y_, &uy_, &next_, &next_u_, &moved_}) x->resize(rows);
  }

  Solved solve(const FrictionProblem&, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.02});
    const double first = w_.begin_at(r, u_);
    iteration.evaluated(first, r);
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
      if (iteration.error_due()) iteration.evaluated(w_.error(r, u_), r);
    }
    return iteration.finish(std::move(r));
  }

 private:
  /// Nesterov's momentum from nothing: the extrapolated point is the iterate.
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
    return curvature * step_ <= (1.0 + 1e-10) * w_.scaled_dot(moved_, moved_) ||
           step_ < 1e-3 * first_step_;
  }

  /// The step counts: next extrapolation, or a restart where it went against the gradient.
  void accept(Impulses& r) {
    const Eigen::VectorXd& gone = (y_ = next_ - r);  // y has been used
    // Where the gradient step points against the way gone, the momentum has carried too far.
    const bool uphill = w_.scaled_dot(moved_, gone) < 0.0;
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
