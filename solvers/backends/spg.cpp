#include "solvers/backends/spg.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

// d = P_K(r - alpha rho (u + s n)) - r,  r+ = r + t d. The energy is quadratic, so along d it is
// known from one product:
//   f(r + t d) = f(r) + t g.d + t^2/2 d.W d
// and only differences of it are kept (an unsymmetric W has no energy: then this is a measure of
// progress, no more).
class Spg final : public Solver {
 public:
  explicit Spg(const SpgSettings& settings) : settings_(settings) {}

  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    first_step_ = gradient_step(w_);
    for (Eigen::VectorXd* x : {&u_, &d_, &next_u_, &next_}) x->resize(problem.row_count());
  }

  Solved solve(const FrictionProblem&, Impulses r, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.02});
    const double first = w_.begin_at(r, u_);
    iteration.evaluated(first, r);
    shift_.reset(w_);
    alpha_ = first_step_;
    while (iteration.next()) {
      if (iteration.count() % settings_.shift_every == 1 || settings_.shift_every == 1)
        renew_energy();
      advance(r);
      if (!iteration.error_due()) continue;
      w_.velocity(r, u_);  // without the rounding that the steps have left in it
      iteration.evaluated(w_.error(r, u_), r);
    }
    return iteration.finish(std::move(r));
  }

 private:
  /// Another s is another energy: the old ones say nothing about it.
  void renew_energy() {
    shift_.follow(w_, u_);
    energies_.assign(settings_.memory, -std::numeric_limits<double>::infinity());
    energies_[0] = energy_ = 0.0;
    newest_ = 0;
  }

  /// The direction d, its slope g.d, a step along it, and the next alpha.
  void advance(Impulses& r) {
    double slope = 0.0;
    for (int c = 0; c < w_.contact_count(); ++c) {
      const Eigen::Vector3d rc = w_.at(r, c), g = shift_.shifted(w_, u_, c);
      const double rho = w_.rho()[c];
      const Eigen::Vector3d d =
          rho > 0.0 ? (project_cone(rc - alpha_ * rho * g, w_.friction(c)) - rc).eval()
                    : Eigen::Vector3d::Zero();
      // A projection gives g.d <= -|d|^2 / (alpha rho); with g large and d small the product itself
      // is all rounding.
      if (rho > 0.0) slope += std::min(g.dot(d), -d.squaredNorm() / (alpha_ * rho));
      w_.put(d_, c, d);
    }
    next_ = r + d_;
    w_.multiply(
        d_, wd_);  // not a difference of velocities: near the solution nothing of it would be left
    next_u_ = u_ + wd_;
    const double curvature = d_.dot(wd_);
    const double t = line_search(slope, curvature);
    energy_ += t * (slope + 0.5 * t * curvature);
    newest_ = (newest_ + 1) % settings_.memory;
    energies_[newest_] = energy_;
    choose_step(curvature);
    if (t == 1.0) {
      r.swap(next_);
      u_.swap(next_u_);
    } else {
      r += t * d_;
      u_ += t * wd_;
    }
  }

  /// The full step when the energy stays below the worst of the last ones, the minimum along d
  /// otherwise.
  double line_search(double slope, double curvature) const {
    const double worst = *std::max_element(energies_.begin(), energies_.end());
    if (energy_ + slope + 0.5 * curvature <= worst + 1e-4 * slope) return 1.0;
    // However short: a step held to a tenth climbs where W is nearly singular and alpha long (a
    // stack of mass ratio 1e6).
    return curvature > 0.0 ? std::clamp(-slope / curvature, 0.0, 1.0) : 1.0;
  }

  /// Barzilai-Borwein, the two formulas in turn.
  void choose_step(double curvature) {
    // A step d changes the gradient by W d: d.d / d.W d is the long step, d.W d / |W d|^2 the short
    // one, in the product in which W's diagonal is about one.
    double across = 0.0;  // |W d|^2 in the scaled product
    for (int c = 0; c < w_.contact_count(); ++c)
      across += w_.rho()[c] * w_.at(wd_, c).squaredNorm();
    const double along = w_.scaled_dot(d_, d_);
    long_turn_ = !long_turn_;
    const double alpha = long_turn_ ? along / curvature : curvature / across;
    alpha_ = curvature > 0.0 && std::isfinite(alpha)
                 ? std::clamp(alpha, 1e-3 * first_step_, 1e6 * first_step_)
                 : first_step_;
  }

  SpgSettings settings_;
  ContactOperator w_;
  SlipShift shift_;
  Eigen::VectorXd u_, d_, wd_, next_, next_u_;
  std::vector<double> energies_;
  int newest_ = 0;
  double energy_ = 0.0, first_step_ = 1.0, alpha_ = 1.0;
  bool long_turn_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_spg(const SpgSettings& settings) {
  return std::make_unique<Spg>(settings);
}

}  // namespace ballast
