#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solvers/backends/backends.hpp"
#include "solvers/parts/newton_system.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

//   min over v  1/2 (v - v_free).M (v - v_free) + sum_c epsilon_c / 2 |gamma_c|^2,
//   gamma_c = P_K(r_c - u_c / epsilon_c),  u = H v + bias,  epsilon_c = regularisation
//   lambda_max(W_cc)
//
// by Newton with an exact line search; then r := gamma, and the next problem follows. Where only W
// is known the velocities are those of impulses lambda, v = v_free + M^-1 H^T lambda, and lambda
// are Newton's unknowns: W must then be symmetric.
class Sap final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    if (!problem.has_dynamics) {
      // The minimised energy has W for its kinetic part, so W must be symmetric.
      const SparseRows &w = problem.delassus.w, transposed = w.transpose();
      if ((w - transposed).norm() > 1e-9 * w.norm())
        throw UnsupportedProblem(
            "sap: the stored W is not symmetric: there is no energy to minimise");
      newton_.prepare(w_);
      linear_.resize(problem.contact_count());
    } else {
      bodies_.prepare(problem);
      mass_ = sparse_mass(problem.dynamics);
    }
    hessian_.resize(problem.contact_count());
    no_shift_.reset(w_);
  }

  void use_team(WorkerTeam* team) override { bodies_.use_team(team); }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Iteration iteration(budget, {1, 1.0});
    gamma_ = std::move(start);
    iteration.evaluated(w_.project_and_evaluate(gamma_, true_u_), gamma_);
    centre_ = gamma_;
    if (!problem.has_dynamics)
      lambda_ = gamma_;
    else
      body_velocity(problem.dynamics, problem.row_begin, gamma_, v_);
    int newtons = 0;  // steps on the problem at hand
    bool done = false;
    while (!done && iteration.next()) {
      if (newtons == 0) place(problem);
      const double decrement = newton(problem);
      w_.velocity(gamma_, true_u_);
      iteration.evaluated(std::isfinite(decrement) ? w_.error(gamma_, true_u_) : decrement, gamma_);
      // Far from the end a proximal step need not be exact.
      const bool solved = decrement <= std::max(1e-2 * proximal_energy(), least_energy_);
      if (!solved && ++newtons < most_newtons) continue;
      // Done where the relaxation is solved: going on does not reach Coulomb's law.
      done = no_shift_.convex_error(w_, gamma_, true_u_) <= 0.5 * budget.aim();
      centre_ = gamma_;
      newtons = 0;
    }
    const double own_residual = no_shift_.convex_error(w_, gamma_, true_u_);
    Solved solved = iteration.finish(std::move(gamma_));
    if (done && solved.reason != StopReason::reached_tolerance) solved.reason = StopReason::stalled;
    solved.own_residual = own_residual;
    return solved;
  }

 private:
  double epsilon(int c) const { return regularisation / w_.rho()[c]; }
  Eigen::Vector3d pressed(int c, const Eigen::Vector3d& u) const {
    return w_.at(centre_, c) - u / epsilon(c);
  }

  /// Computes u and gamma at velocities v_; for a stored W, v_ is v_free + M^-1 H^T lambda_.
  void place(const FrictionProblem& problem) {
    if (!problem.has_dynamics)
      w_.velocity(lambda_, u_);
    else
      body_to_contact_velocity(problem.dynamics, problem.row_begin, v_, u_);
    // gamma = P_K(r - u / epsilon): the impulse of a contact that gives way by epsilon.
    for (int c = 0; c < w_.contact_count(); ++c) w_.put(gamma_, c, pressed(c, w_.at(u_, c)));
    w_.project(gamma_);
  }

  /// One step in v_, with u and gamma after it. Returns -gradient.dv [J], twice the gain that the
  /// model promised; not finite: the factorisation failed.
  double newton(const FrictionProblem& problem) {
    // The energy's second derivative is M + H^T (P_K' / epsilon) H: contacts are springs of
    // stiffness 1 / epsilon, which the projection's derivative turns, weakens or switches off.
    for (int c = 0; c < w_.contact_count(); ++c) {
      hessian_[c].setZero();
      if (w_.rho()[c] > 0.0)
        hessian_[c] = project_cone_jacobian(pressed(c, w_.at(u_, c)), w_.friction(c)) / epsilon(c);
    }
    if (!problem.has_dynamics) return newton_on_impulses(problem);
    if (!bodies_.factor(hessian_)) return std::numeric_limits<double>::quiet_NaN();
    // The gradient M (v - v_free) - H^T gamma, and the Newton direction.
    contact_to_body_impulse(problem.dynamics, problem.row_begin, gamma_, gradient_);
    away_ = mass_ * (v_ - problem.dynamics.v_free);
    // A decrement so small beside the energy moves velocities by 1e-13 of themselves: rounding.
    least_energy_ = 1e-26 * std::abs(away_.dot(v_ - problem.dynamics.v_free));
    gradient_ = away_ - gradient_;
    bodies_.solve_once(gradient_, dv_);
    dv_ = -dv_;
    const double decrement = -gradient_.dot(dv_);
    body_to_contact_velocity(problem.dynamics, problem.row_begin, dv_, du_);
    du_ -= problem.dynamics.bias;
    v_ += line_search(away_.dot(dv_), dv_.dot(mass_ * dv_)) * dv_;
    place(problem);
    return decrement;
  }

  /// The same step where only W is known: the gradient is H^T (lambda - gamma), and
  ///   (I + G W) dlambda = gamma - lambda,   du = W dlambda
  double newton_on_impulses(const FrictionProblem& problem) {
    for (int c = 0; c < w_.contact_count(); ++c)
      linear_[c] = {w_.at(lambda_, c) - w_.at(gamma_, c), Eigen::Matrix3d::Identity(), hessian_[c]};
    if (!newton_.solve(linear_, dv_)) return std::numeric_limits<double>::quiet_NaN();
    w_.multiply(dv_, du_);
    const double decrement = (gamma_ - lambda_).dot(du_);
    w_.multiply(lambda_, away_);
    least_energy_ = 1e-26 * std::abs(away_.dot(lambda_));
    lambda_ += line_search(lambda_.dot(du_), dv_.dot(du_)) * dv_;
    place(problem);
    return decrement;
  }

  /// Minimises the convex energy along dv: brackets the zero of its slope, and finds it by secants
  /// kept inside the bracket (Illinois). `slope` and `curvature` are those of the kinetic part.
  double line_search(double slope, double curvature) const {
    // |P_K(z)|^2 / 2 has the gradient P_K(z), so that a contact's epsilon |gamma|^2 / 2 with z = r
    // - u / epsilon changes by -gamma.du.
    const auto derivative = [&](double t) {
      double sum = slope + t * curvature;
      for (int c = 0; c < w_.contact_count(); ++c)
        if (w_.rho()[c] > 0.0) {
          const Eigen::Vector3d du = w_.at(du_, c);
          sum -= project_cone(pressed(c, w_.at(u_, c) + t * du), w_.friction(c)).dot(du);
        }
      return sum;
    };
    double low = 0.0, high = 1.0, at_low = derivative(low), at_high = derivative(high);
    const double enough = 1e-8 * std::abs(at_low);
    while (at_high < 0.0 && high < 16.0) {
      low = high;
      at_low = at_high;
      high *= 2.0;
      at_high = derivative(high);
    }
    if (std::abs(at_high) <= enough || at_high < 0.0) return high;
    // Secants; an end that stays twice has its slope halved (Illinois).
    int last_side = 0;
    for (int k = 0; k < 60 && at_low < 0.0; ++k) {
      const double t = (low * at_high - high * at_low) / (at_high - at_low), at_t = derivative(t);
      if (std::abs(at_t) <= enough) return t;
      const int side = at_t > 0.0 ? 1 : -1;
      if (side > 0) {
        high = t;
        at_high = at_t;
        if (last_side == side) at_low *= 0.5;
      } else {
        low = t;
        at_low = at_t;
        if (last_side == side) at_high *= 0.5;
      }
      last_side = side;
    }
    return low > 0.0 ? low : high;
  }

  /// sum epsilon |gamma - centre|^2 [J]: how far the proximal step moves, as an energy.
  double proximal_energy() const {
    double sum = 0.0;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (w_.rho()[c] > 0.0)
        sum += epsilon(c) * (w_.at(gamma_, c) - w_.at(centre_, c)).squaredNorm();
    return sum;
  }

  static constexpr int most_newtons = 50;         ///< for one problem
  static constexpr double regularisation = 1e-3;  ///< Drake's sigma
  ContactOperator w_;
  BodyMatrix bodies_;  ///< M + H^T (P_K' / epsilon) H
  SlipShift no_shift_;
  SparseColumns mass_;
  std::vector<Eigen::Matrix3d> hessian_;
  NewtonSystem newton_;  ///< of a stored W
  std::vector<ContactLinearisation> linear_;
  Impulses lambda_;
  Eigen::VectorXd v_, dv_, u_, du_, true_u_, gamma_, centre_, gradient_, away_;
  double least_energy_ = 0.0;
};

}  // namespace

std::unique_ptr<Solver> make_sap() { return std::make_unique<Sap>(); }

}  // namespace ballast
