#include "solvers/parts/cone_step.hpp"

#include <algorithm>
#include <cmath>

namespace ballast::lorentz {
namespace {

/// x.J x = (x_0 - |x_1|)(x_0 + |x_1|), J = diag(1, -1, -1): as a product, without cancellation of
/// squares.
double determinant(const Vector& x) {
  const double t = std::hypot(x[1], x[2]);
  return (x[0] - t) * (x[0] + t);
}

Vector reflect(const Vector& x) { return {x[0], -x[1], -x[2]}; }

/// 2 v v^T - J.
/// Where v.J v = 1 it maps the cone onto itself, and its inverse is the same of J v.
Matrix hyperbolic_reflection(const Vector& v) {
  Matrix h = 2.0 * v * v.transpose();
  h(0, 0) -= 1.0;
  h(1, 1) += 1.0;
  h(2, 2) += 1.0;
  return h;
}

}  // namespace

double depth(const Vector& x) { return x[0] - std::hypot(x[1], x[2]); }

Vector product(const Vector& x, const Vector& y) {
  return {x.dot(y), x[0] * y[1] + y[0] * x[1], x[0] * y[2] + y[0] * x[2]};
}

Vector divide(const Vector& x, const Vector& z) {
  // With x = (x_0, x'): x o y = z says x.y = z_0 and x_0 y' + y_0 x' = z'. The latter gives y', and
  // put into the former it leaves y_0 det x = x_0 z_0 - x'.z'.
  const double y0 = (x[0] * z[0] - x[1] * z[1] - x[2] * z[2]) / determinant(x);
  return {y0, (z[1] - y0 * x[1]) / x[0], (z[2] - y0 * x[2]) / x[0]};
}

double longest_step(const Vector& x, const Vector& d, double most) {
  // det(x + t d) = a t^2 + 2 b t + c vanishes where the path meets the boundary. Of its roots q / a
  // and c / q neither suffers from cancellation, as q has no difference in it.
  const double a = determinant(d), c = determinant(x), b = x[0] * d[0] - x[1] * d[1] - x[2] * d[2];
  double step = most;
  if (d[0] < 0.0) step = std::min(step, -x[0] / d[0]);
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return step;
  const double root = std::sqrt(discriminant), q = -(b + (b >= 0.0 ? root : -root));
  if (q != 0.0 && c / q > 0.0) step = std::min(step, c / q);
  if (a != 0.0 && q / a > 0.0) step = std::min(step, q / a);
  return step;
}

bool scale(const Vector& x, const Vector& z, bool half_line, Scaling& scaling) {
  const double x_det = half_line ? x[0] * x[0] : determinant(x),
               z_det = half_line ? z[0] * z[0] : determinant(z);
  if (!(x[0] > 0.0 && z[0] > 0.0 && x_det > 0.0 && z_det > 0.0)) return false;
  // Nesterov and Todd's F has F^2 x = z. With x^ = x / sqrt(det x), z^
  // likewise, J = diag(1, -1, -1):
  //
  //     gamma^2 = (1 + x^.z^) / 2,    w = (z^ + J x^) / (2 gamma),    beta^4 = det z / det x
  //     F^2 = beta^2 (2 w w' - J),    F = beta (2 v v' - J),    v = (w + e_0) / sqrt(2 (w_0 + 1))
  const double beta_square = std::sqrt(z_det / x_det), beta = std::sqrt(beta_square);
  Vector w(1.0, 0.0, 0.0);
  if (!half_line) {
    const Vector xn = x / std::sqrt(x_det), zn = z / std::sqrt(z_det);
    const double gamma = std::sqrt(0.5 * (1.0 + xn.dot(zn)));
    w = (zn + reflect(xn)) / (2.0 * gamma);
  }
  const Vector v = (w + Vector(1.0, 0.0, 0.0)) / std::sqrt(2.0 * (w[0] + 1.0));
  scaling.f = beta * hyperbolic_reflection(v);
  scaling.f_inverse = hyperbolic_reflection(reflect(v)) / beta;
  // 2 w w^T - J with w_0^2 - |w_1..|^2 = 1: (w_0 +- |w_1..|)^2 along (1, +- w_1.. / |w_1..|), 1
  // across.
  const double length = std::hypot(w[1], w[2]), stretch = (w[0] + length) * (w[0] + length);
  const double cosine = length > 0.0 ? w[1] / length : 1.0,
               sine = length > 0.0 ? w[2] / length : 0.0;
  const double half = std::sqrt(0.5);
  scaling.eigenvalues = beta_square * Vector(stretch, 1.0 / stretch, 1.0);
  scaling.axes << half, half, 0.0, half * cosine, -half * cosine, -sine, half * sine, -half * sine,
      cosine;
  if (half_line) {
    scaling.eigenvalues.setConstant(beta_square);
    scaling.axes.setIdentity();
  }
  scaling.lambda = scaling.f * x;
  return scaling.lambda.allFinite() && scaling.eigenvalues.allFinite() &&
         (half_line || depth(scaling.lambda) > 0.0);
}

}  // namespace ballast::lorentz

namespace ballast {

void ConeStep::prepare(ContactOperator& w) {
  w_ = &w;
  system_.prepare(w);
  for (Eigen::VectorXd* x : {&right_, &dr_, &dg_}) x->resize(w.problem().row_count());
  const std::size_t contacts = w.contact_count();
  scaling_.resize(contacts);
  sigma_.resize(contacts);
  shift_blocks_.resize(contacts);
  target_.resize(contacts);
}

/// x = (mu r_N, r_T): in Lorentz's cone exactly where |r_T| <= mu r_N.
ConeStep::Vector ConeStep::to_cone(const Eigen::VectorXd& r, int c) const {
  const Vector x = w_->at(r, c);
  return half_line(c) ? Vector(x[0], 0.0, 0.0) : Vector(w_->friction(c) * x[0], x[1], x[2]);
}

/// z = (g_N / mu, g_T): in the same cone exactly where mu |g_T| <= g_N, and x.z = r.g.
ConeStep::Vector ConeStep::to_dual(const Eigen::VectorXd& g, int c) const {
  const Vector z = w_->at(g, c);
  return half_line(c) ? Vector(z[0], 0.0, 0.0) : Vector(z[0] / w_->friction(c), z[1], z[2]);
}

/// S z: from the cone's rows to a velocity; its inverse maps to an impulse.
ConeStep::Vector ConeStep::from_dual(const Vector& z, int c) const {
  return half_line(c) ? Vector(z[0], 0.0, 0.0) : Vector(w_->friction(c) * z[0], z[1], z[2]);
}

bool ConeStep::factor(const ConePoint& point) {
  for (int c = 0; c < w_->contact_count(); ++c)
    if (!scale_contact(point, c)) return false;
  return system_.factor(shift_blocks_, sigma_);
}

/// The blocks P and P^-1 of one contact.
bool ConeStep::scale_contact(const ConePoint& point, int c) {
  // What may not move does not: a huge P allows no dr.
  constexpr double nothing = 1e-20;
  const double lambda_max = moves(c) ? 1.0 / w_->rho()[c] : 1.0;
  sigma_[c] = nothing / lambda_max * Eigen::Matrix3d::Identity();
  shift_blocks_[c] = lambda_max / nothing * Eigen::Matrix3d::Identity();
  if (!moves(c)) return true;
  lorentz::Scaling& scaling = scaling_[c];
  if (!lorentz::scale(to_cone(point.r, c), to_dual(point.g, c), half_line(c), scaling))
    return false;
  // F^2 takes x to z. It grows without bound where the impulse of an opening contact vanishes, and
  // vanishes where the velocity of a sticking one does. The bounds keep W + P within what a
  // factorisation in doubles can take.
  const double least = settings_.least_shift * lambda_max,
               most = lambda_max / settings_.least_shift;
  const auto bounded = [=](double e) { return std::clamp(e, least, most); };
  if (half_line(c)) {
    shift_blocks_[c](0, 0) = bounded(scaling.eigenvalues[0]);
    sigma_[c](0, 0) = 1.0 / shift_blocks_[c](0, 0);
    return true;
  }
  // P = S F^2 S and its inverse, both from the eigenvalues of F^2: neither is inverted from the
  // other.
  const Vector s(w_->friction(c), 1.0, 1.0), inverse = s.cwiseInverse();
  shift_blocks_[c] = s.asDiagonal() * scaling.of_square(bounded) * s.asDiagonal();
  sigma_[c] = inverse.asDiagonal() * scaling.of_square([&](double e) { return 1.0 / bounded(e); }) *
              inverse.asDiagonal();
  return true;
}

double ConeStep::barrier() const {
  // x.z = (F x).(F^-1 z) = |lambda|^2.
  double sum = 0.0;
  for (int c = 0; c < w_->contact_count(); ++c)
    if (moves(c)) sum += scaling_[c].lambda.squaredNorm();
  const int cones = moving_contacts();
  return cones > 0 ? sum / cones : 0.0;
}

double ConeStep::head_impulses(const Eigen::VectorXd& r) const {
  double sum = 0.0;
  for (int c = 0; c < w_->contact_count(); ++c)
    if (moves(c)) sum += to_cone(r, c)[0];
  return sum;
}

int ConeStep::moving_contacts() const {
  return static_cast<int>(
      std::count_if(w_->rho().begin(), w_->rho().end(), [](double rho) { return rho > 0.0; }));
}

bool ConeStep::advance(const SlipShift& shift, const Eigen::VectorXd& u, ConePoint& point) {
  const double nu = barrier();
  // Predictor: straight to the solution, and how far along it the cones allow.
  for (int c = 0; c < w_->contact_count(); ++c)
    target_[c] = -lorentz::product(scaling_[c].lambda, scaling_[c].lambda);
  solve_newton(shift, u, point);
  const double predicted = longest(point, 1.0);
  // Corrector: back to the middle as much as the predictor fell short, and its second-order term.
  // Mehrotra's choice: a predictor that could go all the way leaves sigma = 0 and nothing is
  // centred; one that was blocked at once gives sigma = 1.
  const double sigma = std::pow(1.0 - predicted, 3.0);
  for (int c = 0; c < w_->contact_count(); ++c) {
    const Vector dx = scaling_[c].f * to_cone(dr_, c), dz = scaling_[c].f_inverse * to_dual(dg_, c);
    target_[c] -= lorentz::product(dx, dz);
    target_[c][0] += sigma * nu;
  }
  solve_newton(shift, u, point);
  // Stopping short of the boundary: on it the next scaling would not exist.
  const double length = longest(point, settings_.to_boundary);
  point.r += length * dr_;
  point.g += length * dg_;
  return point.r.allFinite() && point.g.allFinite();
}

/// dr, dg for the complementarity residuals in target_.
void ConeStep::solve_newton(const SlipShift& shift, const Eigen::VectorXd& u,
                            const ConePoint& point) {
  // The right-hand side -e + S F (lambda \ c), zero where nothing moves.
  for (int c = 0; c < w_->contact_count(); ++c) {
    Vector b = Vector::Zero();
    if (moves(c)) {
      const Vector pull = lorentz::divide(scaling_[c].lambda, target_[c]);
      b = w_->at(point.g, c) - shift.shifted(*w_, u, c) + from_dual(scaling_[c].f * pull, c);
      if (half_line(c)) b[1] = b[2] = 0.0;
    }
    w_->put(right_, c, b);
  }
  // From lambda o (F dx + F^-1 dz) = c: dz = F (lambda \ c - F dx).
  system_.solve(right_, dr_, settings_.refinements);
  for (int c = 0; c < w_->contact_count(); ++c) {
    Vector dr = w_->at(dr_, c);
    if (half_line(c)) dr[1] = dr[2] = 0.0;
    if (!moves(c)) dr.setZero();
    w_->put(dr_, c, dr);
    const Vector pull = lorentz::divide(scaling_[c].lambda, target_[c]);
    const Vector dz = scaling_[c].f * (pull - scaling_[c].f * to_cone(dr_, c));
    w_->put(dg_, c, moves(c) ? from_dual(dz, c) : Vector::Zero());
  }
}

/// `part` of the longest step that stays in all cones, at most a whole one.
double ConeStep::longest(const ConePoint& point, double part) const {
  double step = 1.0 / part;
  for (int c = 0; c < w_->contact_count(); ++c)
    if (moves(c)) {
      step = lorentz::longest_step(to_cone(point.r, c), to_cone(dr_, c), step);
      step = lorentz::longest_step(to_dual(point.g, c), to_dual(dg_, c), step);
    }
  return std::min(1.0, part * step);
}

}  // namespace ballast
