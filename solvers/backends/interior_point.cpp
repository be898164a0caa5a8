#include "solvers/backends/interior_point.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/backends/newton.hpp"
#include "solvers/parts/cone_step.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

// Judged and returned is P_K(r - rho g): open contacts have no impulse there, though the point's
// own r lies inside the cones.
class InteriorPoint final : public Solver {
 public:
  explicit InteriorPoint(double polish_from) : polish_from_(polish_from) {}

  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    cone_step_.prepare(w_);
    free_contact_velocity(problem, q_);
    for (Eigen::VectorXd* x : {&u_, &point_.r, &point_.g, &rounded_u_})
      x->resize(problem.row_count());
    is_polisher_ready_ = false;  // its order and analysis are dear, and most solves do without
  }

  void use_team(WorkerTeam* team) override {
    cone_step_.use_team(team);
    polisher_->use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Course course(budget, std::move(start));
    bool rest = false;  // proximal Newton goes the rest of the way
    course.run([&](Impulses r, Budget left) {
      left.tolerance = std::max(budget.tolerance, polish_from_ * velocity_scale());
      Solved solved = approach(std::move(r), left);
      // Near enough for the other, which is not yet what was asked.
      if (solved.reason == StopReason::reached_tolerance && solved.own_residual > budget.aim())
        solved.reason = StopReason::stalled;
      rest = solved.reason == StopReason::stalled;
      return solved;
    });
    if (!rest) return course.finish();
    if (!is_polisher_ready_) polisher_->prepare(problem);
    is_polisher_ready_ = true;
    course.run(*polisher_, problem, budget.max_iterations);
    return course.finish();
  }

 private:
  /// Interior-point steps with s-updates between them. Returns the best of the points judged.
  Solved approach(Impulses r, const Budget& budget) {
    Iteration iteration(budget, {1, 1.0});
    double best_error = w_.begin_at(r, u_), stall_error = best_error;
    iteration.evaluated(best_error, r);
    begin(r);
    Impulses best = r;
    push_inside();
    before_ = point_;
    rounded_u_ = u_;
    int steps = 0, stalled_steps = 0;  // with this s; without the best error halved
    while (stalled_steps < patience && iteration.next()) {
      const bool stepped = step();
      if (stepped) {
        w_.velocity(point_.r, u_);
        round(r);
        w_.velocity(r, rounded_u_);
        const double error = w_.error(r, rounded_u_);
        if (error < best_error) {
          best_error = error;
          best = r;
        }
      }
      iteration.evaluated(best_error, best);
      ++stalled_steps;
      if (best_error <= 0.5 * stall_error) {
        stall_error = best_error;
        stalled_steps = 0;
      }
      // The same s again, until the convex problem is solved well beyond what s has still to move.
      const double still = shift_.distance(w_, rounded_u_);
      if (stepped && ++steps < most_steps &&
          shift_.convex_error(w_, r, rounded_u_) > inner_part * still)
        continue;
      shift_.improve(w_, rounded_u_);
      go_back();
      steps = 0;
    }
    Solved solved = iteration.finish(std::move(best));
    if (solved.reason == StopReason::numerical_failure) solved.reason = StopReason::stalled;
    return solved;
  }

  /// rms of the problem's own velocity q [m/s].
  double velocity_scale() const {
    const double scale = q_.size() > 0 ? std::sqrt(q_.squaredNorm() / q_.size()) : 0.0;
    return scale > 0.0 ? scale : 1.0;
  }

  /// s and the point at `start`, whose velocities are u_.
  void begin(const Impulses& start) {
    shift_.reset(w_);
    shift_.follow(w_, u_);
    point_.r = start;
  }

  /// The point, and the velocities u_ that it gives, moved inside both cones by the problem's own
  /// velocity.
  void push_inside() {
    const double push = velocity_scale();
    for (int c = 0; c < w_.contact_count(); ++c) {
      Eigen::Vector3d r = w_.at(point_.r, c), g = shift_.shifted(w_, u_, c);
      const double mu = w_.friction(c), rho = w_.rho()[c];
      // In the cone's variables (mu r_N, r_T) and (g_N / mu, g_T) the first entries grow by push
      // rho and by push: impulse and velocity leave their boundaries alike.
      if (mu > 0.0) {
        r[0] += push * rho / mu;
        g = project_dual_cone(g, mu);
        g[0] += push * mu;
      } else {
        r = {r[0] + push * rho, 0.0, 0.0};
        g = {std::max(g[0], 0.0) + push, 0.0, 0.0};
      }
      w_.put(point_.r, c, rho > 0.0 ? r : Eigen::Vector3d::Zero());
      w_.put(point_.g, c, g);
    }
    w_.velocity(point_.r, u_);
  }

  bool step() {
    if (!cone_step_.factor(point_)) return false;
    keep_for_next();
    return cone_step_.advance(shift_, u_, point_);
  }

  /// A new s begins at the last iterate whose barrier was not yet below what s had still to move:
  /// nearer to the cones' sides it could not follow.
  void keep_for_next() {
    // Both sides are energies: the sum of x.z, and what s has to move times the sum of mu r_N.
    const double product = cone_step_.barrier() * cone_step_.moving_contacts();
    if (!(product < shift_.distance(w_, u_) * cone_step_.head_impulses(point_.r))) before_ = point_;
  }
  void go_back() {
    point_ = before_;
    w_.velocity(point_.r, u_);
  }

  void round(Impulses& r) const {
    // P_K(r - rho g), the projection in the judge's natural map.
    r = point_.r;
    for (int c = 0; c < w_.contact_count(); ++c)
      w_.put(r, c, w_.at(point_.r, c) - w_.rho()[c] * w_.at(point_.g, c));
    w_.project(r);
  }

  /// s is renewed when the convex problem is solved to this part of what s has to move.
  static constexpr double inner_part = 0.1;
  static constexpr int most_steps = 25;  ///< with one s
  static constexpr int patience = 40;    ///< steps without the best error halved
  const double polish_from_;
  ContactOperator w_;
  ConeStep cone_step_;
  SlipShift shift_;
  ConePoint point_, before_;  ///< now; where the next s begins
  Eigen::VectorXd q_, u_, rounded_u_;
  /// Begins at once: sweeps would undo what the interior point has balanced.
  std::unique_ptr<Solver> polisher_ = make_proximal_newton({.start_sweeps = 0});
  bool is_polisher_ready_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_interior_point(double polish_from) {
  return std::make_unique<InteriorPoint>(polish_from);
}

}  // namespace ballast
