#include "solvers/parts/lorentz_cone.hpp"

#include <algorithm>
#include <cmath>

namespace ballast::lorentz {
namespace {

/// x.J x with J = diag(1, -1, -1), as the product (x_0 - |x_1..|)(x_0 + |x_1..|): this avoids the
/// cancellation of squares.
double determinant(const Vector& x) {
  const double t = std::hypot(x[1], x[2]);
  return (x[0] - t) * (x[0] + t);
}

Vector reflect(const Vector& x) { return {x[0], -x[1], -x[2]}; }

/// 2 v v^T - J. Where v.J v = 1 it maps the cone onto itself, and its inverse is the matrix of J v.
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
  // With x = (x_0, x'), x o y = z means x.y = z_0 and x_0 y' + y_0 x' = z'. The second gives y';
  // put into the first it leaves y_0 det x = x_0 z_0 - x'.z'.
  const double y0 = (x[0] * z[0] - x[1] * z[1] - x[2] * z[2]) / determinant(x);
  return {y0, (z[1] - y0 * x[1]) / x[0], (z[2] - y0 * x[2]) / x[0]};
}

double longest_step(const Vector& x, const Vector& d, double most) {
  // det(x + t d) = a t^2 + 2 b t + c vanishes where the path meets the boundary. Its roots q / a
  // and c / q do not suffer from cancellation, as q has no difference in it.
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
  // With w_0^2 - |w_1..|^2 = 1 the eigenvalues of 2 w w^T - J are (w_0 +- |w_1..|)^2 along (1, +-
  // w_1.. / |w_1..|), and 1 across.
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
