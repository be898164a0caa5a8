#include "solvers/backends/interior_point.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "solvers/backends/newton.hpp"
#include "solvers/parts/nesterov_todd.hpp"
#include "solvers/parts/shifted_delassus.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

using lorentz::Vector;

// Each contact in Lorentz's cone, x = (mu r_N, r_T), z = (g_N / mu, g_T), g = u + s n; without
// friction x = r_N, z = u_N on the half-line (r_T = 0). One step, with the residual e = u + s n -
// g:
//   (W + P) dr = -e + S F (lambda \ c),   P = S F^2 S,  S = diag(mu, 1, 1),   dg = S (F (lambda
//   \ c) - F^2 S dr)
// predictor: c = -lambda o lambda; corrector: c = sigma nu 1 - lambda o lambda - (F dx) o (F^-1
// dz). Judged and returned is P_K(r - rho g): open contacts have no impulse there, though r lies
// inside the cones.
class InteriorPoint final : public Solver {
 public:
  explicit InteriorPoint(const InteriorPointSettings& settings) : settings_(settings) {}

  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    system_.prepare(w_);
    free_contact_velocity(problem, q_);
    for (Eigen::VectorXd* x : {&u_, &right_, &r_, &g_, &dr_, &dg_, &rounded_u_})
      x->resize(problem.row_count());
    const std::size_t contacts = problem.contact_count();
    scaling_.resize(contacts);
    sigma_.resize(contacts);
    shift_blocks_.resize(contacts);
    target_.resize(contacts);
    polisher_->prepare(problem);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Budget first = budget;
    first.tolerance = std::max(budget.tolerance, settings_.polish_from * velocity_scale());
    Solved solved = approach(std::move(start), first);
    const bool near =
        solved.reason == StopReason::reached_tolerance && solved.own_residual > budget.tolerance;
    if (near || solved.reason == StopReason::stalled) polish(problem, budget, solved);
    return solved;
  }

 private:
  /// Interior-point steps with s-updates between them. Returns the best of the points judged.
  Solved approach(Impulses r, const Budget& budget) {
    Iteration iteration(budget, {1, 1.0});
    begin_time_ = std::chrono::steady_clock::now();
    w_.project(r);
    begin(r);
    Impulses best = r;
    double best_error = w_.error(r, u_), stall_error = best_error;
    iteration.evaluated(best_error);
    push_inside();
    int steps = 0, stalled_steps = 0;  // with this s; without the best error halved
    while (stalled_steps < settings_.patience && iteration.next()) {
      const bool stepped = step();
      if (stepped) {
        w_.velocity(r_, u_);
        round(r);
        w_.velocity(r, rounded_u_);
        const double error = w_.error(r, rounded_u_);
        if (error < best_error) {
          best_error = error;
          best = r;
        }
      }
      iteration.evaluated(best_error);
      ++stalled_steps;
      if (best_error <= 0.5 * stall_error) {
        stall_error = best_error;
        stalled_steps = 0;
      }
      const double still = shift_.distance(w_, rounded_u_);
      if (stepped && ++steps < settings_.most_steps &&
          shift_.convex_error(w_, r, rounded_u_) > settings_.inner_part * still)
        continue;
      shift_.improve(w_, rounded_u_);
      go_back();
      steps = 0;
    }
    Solved solved = iteration.finish(std::move(best));
    if (solved.reason == StopReason::numerical_failure) solved.reason = StopReason::stalled;
    return solved;
  }

  /// The rest of the way by proximal Newton, within what is left of the budget.
  void polish(const FrictionProblem& problem, const Budget& budget, Solved& solved) {
    const double spent =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_time_).count();
    Budget rest = budget;
    rest.max_iterations -= solved.iterations;
    rest.max_seconds = std::max(0.0, budget.max_seconds - spent);
    Solved polished = polisher_->solve(problem, std::move(solved.impulses), rest);
    for (HistoryPoint point : polished.history) {
      if (point.iteration == 0) continue;  // where the approach ended
      point.iteration += solved.iterations;
      point.seconds += spent;
      solved.history.push_back(point);
    }
    solved.iterations += polished.iterations;
    solved.reason = polished.reason;
    solved.own_residual = polished.own_residual;
    solved.impulses = std::move(polished.impulses);
  }

  bool moves(int c) const { return w_.rho()[c] > 0.0; }
  bool half_line(int c) const { return !(w_.friction(c) > 0.0); }

  Vector to_cone(const Eigen::VectorXd& r, int c) const {
    const Vector x = w_.at(r, c);
    return half_line(c) ? Vector(x[0], 0.0, 0.0) : Vector(w_.friction(c) * x[0], x[1], x[2]);
  }
  Vector to_dual(const Eigen::VectorXd& g, int c) const {
    const Vector z = w_.at(g, c);
    return half_line(c) ? Vector(z[0], 0.0, 0.0) : Vector(z[0] / w_.friction(c), z[1], z[2]);
  }
  /// S y: from the cone's rows to a velocity; its inverse maps to an impulse.
  Vector from_dual(const Vector& z, int c) const {
    return half_line(c) ? Vector(z[0], 0.0, 0.0) : Vector(w_.friction(c) * z[0], z[1], z[2]);
  }

  double velocity_scale() const {
    const double scale = q_.size() > 0 ? std::sqrt(q_.squaredNorm() / q_.size()) : 0.0;
    return scale > 0.0 ? scale : 1.0;
  }

  void begin(const Impulses& start) {
    w_.velocity(start, u_);
    shift_.reset(w_);
    shift_.follow(w_, u_);
    r_ = start;
    r_before_.resize(0);
  }

  /// r_ and the velocities u_ that it gives, moved inside both cones by the problem's own velocity.
  void push_inside() {
    const double push = velocity_scale();
    for (int c = 0; c < w_.contact_count(); ++c) {
      Vector r = w_.at(r_, c), g = shift_.shifted(w_, u_, c);
      const double mu = w_.friction(c);
      if (half_line(c)) {
        r = {r[0] + push * w_.rho()[c], 0.0, 0.0};
        g = {std::max(g[0], 0.0) + push, 0.0, 0.0};
      } else {
        r[0] += push * w_.rho()[c] / mu;
        g = project_dual_cone(g, mu);
        g[0] += push * mu;
      }
      w_.put(r_, c, moves(c) ? r : Vector::Zero());
      w_.put(g_, c, g);
    }
    w_.velocity(r_, u_);
  }

  /// A new s begins at the last iterate whose barrier was not yet below what s had still to move:
  /// nearer to the cones' sides it could not follow.
  void keep_for_next(double nu) {
    double impulse = 0.0;
    int cones = 0;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (moves(c)) {
        impulse += to_cone(r_, c)[0];
        ++cones;
      }
    if (r_before_.size() > 0 && nu * cones < shift_.distance(w_, u_) * impulse) return;
    r_before_ = r_;
    g_before_ = g_;
  }
  void go_back() {
    r_ = r_before_;
    g_ = g_before_;
    w_.velocity(r_, u_);
  }

  bool step() {
    if (!scale_cones()) return false;
    if (!system_.factor(shift_blocks_, sigma_)) return false;
    const double nu = barrier();
    keep_for_next(nu);
    for (int c = 0; c < w_.contact_count(); ++c)
      target_[c] = -lorentz::product(scaling_[c].lambda, scaling_[c].lambda);
    solve_newton();
    const double predicted = longest(1.0);
    const double sigma = std::pow(1.0 - predicted, 3.0);
    for (int c = 0; c < w_.contact_count(); ++c) {
      const Vector dx = scaling_[c].f * to_cone(dr_, c),
                   dz = scaling_[c].f_inverse * to_dual(dg_, c);
      target_[c] -= lorentz::product(dx, dz);
      target_[c][0] += sigma * nu;
    }
    solve_newton();
    const double length = longest(settings_.to_boundary);
    r_ += length * dr_;
    g_ += length * dg_;
    return r_.allFinite() && g_.allFinite();
  }

  bool scale_cones() {
    for (int c = 0; c < w_.contact_count(); ++c) {
      const double lambda_max = moves(c) ? 1.0 / w_.rho()[c] : 1.0,
                   nothing = 1e-20;  // what may not move does not
      sigma_[c] = nothing / lambda_max * Eigen::Matrix3d::Identity();
      shift_blocks_[c] = lambda_max / nothing * Eigen::Matrix3d::Identity();
      if (!moves(c)) continue;
      lorentz::Scaling& scaling = scaling_[c];
      if (!lorentz::scale(to_cone(r_, c), to_dual(g_, c), half_line(c), scaling)) return false;
      const double least = settings_.least_shift * lambda_max,
                   most = lambda_max / settings_.least_shift;
      const auto bounded = [=](double e) { return std::clamp(e, least, most); };
      if (half_line(c)) {
        shift_blocks_[c](0, 0) = bounded(scaling.eigenvalues[0]);
        sigma_[c](0, 0) = 1.0 / shift_blocks_[c](0, 0);
        continue;
      }
      const Vector s(w_.friction(c), 1.0, 1.0), inverse = s.cwiseInverse();
      shift_blocks_[c] = s.asDiagonal() * scaling.of_square(bounded) * s.asDiagonal();
      sigma_[c] = inverse.asDiagonal() * scaling.of_square([&](double e) {
        return 1.0 / bounded(e);
      }) * inverse.asDiagonal();
    }
    return true;
  }

  /// The mean of x.z over the cones.
  double barrier() const {
    double sum = 0.0;
    int cones = 0;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (moves(c)) {
        sum += scaling_[c].lambda.squaredNorm();
        ++cones;
      }
    return cones > 0 ? sum / cones : 0.0;
  }

  /// dr, dg for the complementarity residuals in target_.
  void solve_newton() {
    for (int c = 0; c < w_.contact_count(); ++c) {
      Vector b = Vector::Zero();
      if (moves(c)) {
        const Vector pull = lorentz::divide(scaling_[c].lambda, target_[c]);
        b = w_.at(g_, c) - shift_.shifted(w_, u_, c) + from_dual(scaling_[c].f * pull, c);
        if (half_line(c)) b[1] = b[2] = 0.0;
      }
      w_.put(right_, c, b);
    }
    system_.solve(right_, dr_, settings_.refinements);
    for (int c = 0; c < w_.contact_count(); ++c) {
      Vector dr = w_.at(dr_, c);
      if (half_line(c)) dr[1] = dr[2] = 0.0;
      if (!moves(c)) dr.setZero();
      w_.put(dr_, c, dr);
      const Vector pull = lorentz::divide(scaling_[c].lambda, target_[c]);
      const Vector dz = scaling_[c].f * (pull - scaling_[c].f * to_cone(dr_, c));
      w_.put(dg_, c, moves(c) ? from_dual(dz, c) : Vector::Zero());
    }
  }

  double longest(double part) const {
    double step = 1.0 / part;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (moves(c)) {
        step = lorentz::longest_step(to_cone(r_, c), to_cone(dr_, c), step);
        step = lorentz::longest_step(to_dual(g_, c), to_dual(dg_, c), step);
      }
    return std::min(1.0, part * step);
  }

  void round(Impulses& r) const {
    r = r_;
    for (int c = 0; c < w_.contact_count(); ++c)
      w_.put(r, c, w_.at(r_, c) - w_.rho()[c] * w_.at(g_, c));
    w_.project(r);
  }

  InteriorPointSettings settings_;
  ContactOperator w_;
  ShiftedDelassus system_;
  SlipShift shift_;
  std::vector<lorentz::Scaling> scaling_;
  std::vector<Eigen::Matrix3d> sigma_, shift_blocks_;  ///< P^-1, P
  std::vector<Vector> target_;
  Eigen::VectorXd q_, u_, right_, r_, g_, dr_, dg_, rounded_u_, r_before_, g_before_;
  std::unique_ptr<Solver> polisher_ = prox_newton_maker()();
  std::chrono::steady_clock::time_point begin_time_;
};

}  // namespace

std::unique_ptr<Solver> make_interior_point(const InteriorPointSettings& settings) {
  return std::make_unique<InteriorPoint>(settings);
}

SolverMaker interior_point_maker() {
  return [] { return make_interior_point(); };
}

}  // namespace ballast
