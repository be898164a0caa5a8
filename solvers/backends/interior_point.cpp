#include <algorithm>
#include <cmath>
#include <utility>

#include "solvers/backends/backends.hpp"
#include "solvers/parts/lorentz_cone.hpp"
#include "solvers/parts/shifted_delassus.hpp"
#include "solvers/parts/slip_shift.hpp"
#include "solvers/seam/iteration.hpp"

namespace ballast {
namespace {

using lorentz::Vector;

/// A point inside the cones, one entry per row.
struct ConePoint {
  Eigen::VectorXd r;  ///< impulses [N s]
  Eigen::VectorXd g;  ///< dual variable [m/s], which becomes u + s n
};

// The impulses that are judged and returned are P_K(r - rho g), the projection in the judge's
// natural map: open contacts have none there, though the point's own r lies inside the cones.
class InteriorPoint final : public Solver {
 public:
  void prepare(const FrictionProblem& problem) override {
    w_.prepare(problem);
    system_.prepare(w_);
    scaling_.resize(problem.contact_count());
    target_.resize(problem.contact_count());
    free_contact_velocity(problem, q_);
    for (Eigen::VectorXd* x : {&u_, &point_.r, &point_.g, &rounded_u_, &right_, &dr_, &dg_})
      x->resize(problem.row_count());
    polisher_.is_prepared = false;
  }

  void use_team(WorkerTeam* team) override {
    system_.use_team(team);
    polisher_.solver->use_team(team);
  }

  Solved solve(const FrictionProblem& problem, Impulses start, const Budget& budget) override {
    Course course(budget, std::move(start));
    approach(course, std::max(budget.tolerance, polish_from * velocity_scale()));
    course.run(polisher_, problem, budget.max_iterations);
    return course.finish();
  }

 private:
  /// Takes interior-point steps with s-updates between them, until the best error of the judged
  /// points is at most `near`, or the steps stall.
  void approach(Course& course, double near) {
    Impulses r = course.best();
    double halved = w_.project_and_evaluate(r, u_);
    course.offer(r, halved);
    shift_.reset(w_);
    shift_.follow(w_, u_);
    point_.r = r;
    push_inside();
    before_ = point_;
    rounded_u_ = u_;
    int steps = 0, stalled_steps = 0;  // with this s; without the best error halved
    while (!course.over() && stalled_steps < patience &&
           course.error() > near * (1.0 - stop_margin)) {
      course.spend(1);
      const bool stepped = step();
      if (stepped) {
        w_.velocity(point_.r, u_);
        for (int c = 0; c < w_.contact_count(); ++c)
          w_.put(r, c, w_.at(point_.r, c) - w_.rho()[c] * w_.at(point_.g, c));
        const double error = w_.project_and_evaluate(r, rounded_u_);
        course.offer(r, error);
      }
      ++stalled_steps;
      if (course.error() <= 0.5 * halved) {
        halved = course.error();
        stalled_steps = 0;
      }
      // Keeps s until the convex problem is solved well beyond the distance s has still to move.
      const double still = shift_.distance(w_, rounded_u_);
      if (stepped && ++steps < most_steps &&
          shift_.convex_error(w_, r, rounded_u_) > inner_part * still)
        continue;
      shift_.improve(w_, rounded_u_);
      point_ = before_;
      w_.velocity(point_.r, u_);
      steps = 0;
    }
  }

  /// rms of the problem's own velocity q [m/s].
  double velocity_scale() const {
    const double scale = q_.size() > 0 ? std::sqrt(q_.squaredNorm() / q_.size()) : 0.0;
    return scale > 0.0 ? scale : 1.0;
  }

  /// Moves the point inside both cones by the problem's own velocity, and updates u_.
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

  // One step with s held. Each contact is a pair in Lorentz's cone, x = (mu r_N, r_T) and z = (g_N
  // / mu, g_T); without friction a pair on the half-line, x = r_N, z = g_N, and r_T = 0. With S =
  // diag(mu, 1, 1), F the scaling (F x = F^-1 z = lambda) and the residual e = u + s n - g, a step
  // solves
  //
  //   (W + P) dr = -e + S F (lambda \ c),   P = S F^2 S,   dg = S (F (lambda \ c) - F^2 S dr)
  //
  // first with c = -lambda o lambda (predictor), then with c = sigma nu 1 - lambda o lambda
  // - (F dx) o (F^-1 dz) (corrector), nu the mean of x.z. o and \ are the Jordan product and its
  // inverse. False: by rounding the point is not inside, the matrix is singular, or the new point
  // is not finite.
  bool step() {
    for (int c = 0; c < w_.contact_count(); ++c)
      if (!scale_contact(c)) return false;
    if (!system_.factor()) return false;
    // A new s begins at the last iterate whose barrier was not yet below the distance that s had
    // still to move: nearer to the cones' sides it could not follow. Both sides are energies: the
    // sum of x.z = (F x).(F^-1 z) = |lambda|^2, and that distance times the sum of mu r_N.
    const double heads = sum([this](int c) { return to_cone(point_.r, c)[0]; });
    const double product = sum([this](int c) { return scaling_[c].lambda.squaredNorm(); });
    if (!(product < shift_.distance(w_, u_) * heads)) before_ = point_;
    const double moving = sum([](int) { return 1.0; });
    const double nu = moving > 0.0 ? product / moving : 0.0;
    // Predictor: the step straight to the solution, and how much of it the cones allow.
    for (int c = 0; c < w_.contact_count(); ++c)
      target_[c] = -lorentz::product(scaling_[c].lambda, scaling_[c].lambda);
    solve_newton();
    const double predicted = longest(1.0);
    // Corrector: centres by as much as the predictor fell short, and adds its second-order term.
    const double sigma = std::pow(1.0 - predicted, 3.0);
    for (int c = 0; c < w_.contact_count(); ++c) {
      const Vector dx = scaling_[c].f * to_cone(dr_, c),
                   dz = scaling_[c].f_inverse * to_dual(dg_, c);
      target_[c] -= lorentz::product(dx, dz);
      target_[c][0] += sigma * nu;
    }
    solve_newton();
    // The step stops short of the boundary, on which the next scaling would not exist.
    const double length = longest(0.99);
    point_.r += length * dr_;
    point_.g += length * dg_;
    return point_.r.allFinite() && point_.g.allFinite();
  }

  /// The sum over the contacts that move.
  template <typename Summand>
  double sum(const Summand& summand) const {
    double total = 0.0;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (moves(c)) total += summand(c);
    return total;
  }

  bool moves(int c) const { return w_.rho()[c] > 0.0; }
  bool half_line(int c) const { return !(w_.friction(c) > 0.0); }

  /// S x: turns an impulse into the cone's x, and the cone's z into a velocity.
  Vector times_s(const Vector& x, int c) const {
    return half_line(c) ? Vector(x[0], 0.0, 0.0) : Vector(w_.friction(c) * x[0], x[1], x[2]);
  }
  /// x = (mu r_N, r_T): in Lorentz's cone exactly where |r_T| <= mu r_N.
  Vector to_cone(const Eigen::VectorXd& r, int c) const { return times_s(w_.at(r, c), c); }
  /// z = (g_N / mu, g_T): in the same cone exactly where mu |g_T| <= g_N, and x.z = r.g.
  Vector to_dual(const Eigen::VectorXd& g, int c) const {
    const Vector z = w_.at(g, c);
    return half_line(c) ? Vector(z[0], 0.0, 0.0) : Vector(z[0] / w_.friction(c), z[1], z[2]);
  }

  /// The blocks P and P^-1 of one contact. False: by rounding the point is not inside.
  bool scale_contact(int c) {
    Eigen::Matrix3d &p = system_.shift[c], &inverse_p = system_.sigma[c];
    // Rows that may not move have a huge P, which allows no dr.
    constexpr double nothing = 1e-20;
    const double lambda_max = moves(c) ? 1.0 / w_.rho()[c] : 1.0;
    inverse_p = nothing / lambda_max * Eigen::Matrix3d::Identity();
    p = lambda_max / nothing * Eigen::Matrix3d::Identity();
    if (!moves(c)) return true;
    lorentz::Scaling& scaling = scaling_[c];
    if (!lorentz::scale(to_cone(point_.r, c), to_dual(point_.g, c), half_line(c), scaling))
      return false;
    // F^2 takes x to z. It grows without bound where the impulse of an opening contact vanishes,
    // and vanishes where the velocity of a sticking one does. The bounds keep W + P within what a
    // factorisation in doubles can take.
    constexpr double least_shift = 1e-12;
    const double least = least_shift * lambda_max, most = lambda_max / least_shift;
    const auto bounded = [=](double e) { return std::clamp(e, least, most); };
    if (half_line(c)) {
      p(0, 0) = bounded(scaling.eigenvalues[0]);
      inverse_p(0, 0) = 1.0 / p(0, 0);
      return true;
    }
    // P = S F^2 S and its inverse, both from the eigenvalues of F^2: neither is inverted from the
    // other.
    const Vector s(w_.friction(c), 1.0, 1.0), inverse = s.cwiseInverse();
    p = s.asDiagonal() * scaling.of_square(bounded) * s.asDiagonal();
    inverse_p = inverse.asDiagonal() * scaling.of_square([&](double e) {
      return 1.0 / bounded(e);
    }) * inverse.asDiagonal();
    return true;
  }

  /// Solves for dr and dg with the complementarity residuals in target_.
  void solve_newton() {
    // The right-hand side -e + S F (lambda \ c), zero where nothing moves.
    for (int c = 0; c < w_.contact_count(); ++c) {
      Vector b = Vector::Zero();
      if (moves(c)) {
        const Vector pull = lorentz::divide(scaling_[c].lambda, target_[c]);
        b = w_.at(point_.g, c) - shift_.shifted(w_, u_, c) + times_s(scaling_[c].f * pull, c);
        if (half_line(c)) b[1] = b[2] = 0.0;
      }
      w_.put(right_, c, b);
    }
    // From lambda o (F dx + F^-1 dz) = c: dz = F (lambda \ c - F dx). Refined once, because of the
    // scaling's huge range.
    system_.solve(right_, dr_, 1);
    for (int c = 0; c < w_.contact_count(); ++c) {
      Vector dr = w_.at(dr_, c);
      if (half_line(c)) dr[1] = dr[2] = 0.0;
      if (!moves(c)) dr.setZero();
      w_.put(dr_, c, dr);
      const Vector pull = lorentz::divide(scaling_[c].lambda, target_[c]);
      const Vector dz = scaling_[c].f * (pull - scaling_[c].f * to_cone(dr_, c));
      w_.put(dg_, c, moves(c) ? times_s(dz, c) : Vector::Zero());
    }
  }

  /// `part` of the longest step that stays in all cones, at most 1.
  double longest(double part) const {
    double step = 1.0 / part;
    for (int c = 0; c < w_.contact_count(); ++c)
      if (moves(c)) {
        step = lorentz::longest_step(to_cone(point_.r, c), to_cone(dr_, c), step);
        step = lorentz::longest_step(to_dual(point_.g, c), to_dual(dg_, c), step);
      }
    return std::min(1.0, part * step);
  }

  /// The error below which proximal Newton is faster, in units of the rms of q.
  static constexpr double polish_from = 1e-4;
  /// s is renewed when the convex problem is solved to this part of the distance s has to move.
  static constexpr double inner_part = 0.1;
  static constexpr int most_steps = 25;  ///< with one s
  static constexpr int patience = 40;    ///< steps without the best error halved
  ContactOperator w_;
  ShiftedDelassus system_;
  SlipShift shift_;
  ConePoint point_, before_;  ///< now; where the next s begins
  std::vector<lorentz::Scaling> scaling_;
  std::vector<Vector> target_;  ///< c in step()
  Eigen::VectorXd q_, u_, rounded_u_, right_, dr_, dg_;
  /// Begins without sweeps, which would undo the balance of the interior point.
  LazySolver polisher_{make_proximal_newton({.start_sweeps = 0})};
};

}  // namespace

std::unique_ptr<Solver> make_interior_point() { return std::make_unique<InteriorPoint>(); }

}  // namespace ballast
