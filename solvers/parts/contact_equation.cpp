#include "solvers/parts/contact_equation.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// d(u + mu |u_T| n)/du
Matrix3d modified_velocity_jacobian(const Vector3d& u, double mu) {
  Matrix3d a = Matrix3d::Identity();
  const double t = tangential_norm(u);
  if (t > 0.0) a.row(0) += mu / t * Eigen::RowVector3d(0.0, u[1], u[2]);
  return a;
}

ContactLinearisation alart_curnier_linearised(const Vector3d& r, const Vector3d& u, double mu,
                                              double rho) {
  const Vector3d x = r - rho * u;
  // The contact opens: the projection on the half-line is zero, and the disc has no radius.
  if (x[0] <= 0.0) return {r, Matrix3d::Identity(), Matrix3d::Zero()};
  const double t = tangential_norm(x), radius = mu * x[0];
  // The contact sticks: F = rho u.
  if (t <= radius) return {rho * u, Matrix3d::Zero(), rho * Matrix3d::Identity()};
  // The contact slips: the projection is (x_N, mu x_N d) with d = x_T / |x_T|.
  const Vector3d direction(0.0, x[1] / t, x[2] / t);
  Matrix3d projection = Matrix3d::Zero();  // its derivative; the disc's radius moves with x_N
  projection(0, 0) = 1.0;
  projection.block<2, 1>(1, 0) = mu * direction.tail<2>();
  projection.block<2, 2>(1, 1) =
      radius / t *
      (Eigen::Matrix2d::Identity() - direction.tail<2>() * direction.tail<2>().transpose());
  const Vector3d projected = Vector3d(x[0], 0.0, 0.0) + radius * direction;
  return {r - projected, Matrix3d::Identity() - projection, rho * projection};
}

/// The matrix of the Jordan product with x: L_x y = (x.y, x_0 y_1 + y_0 x_1).
Matrix3d arrow(const Vector3d& x) {
  Matrix3d l = x[0] * Matrix3d::Identity();
  l(0, 1) = l(1, 0) = x[1];
  l(0, 2) = l(2, 0) = x[2];
  return l;
}

/// (x^2 + y^2)^(1/2) in the Jordan algebra.
Vector3d jordan_norm(const Vector3d& x, const Vector3d& y) {
  // x o x = (x.x, 2 x_0 x_1..). The root has the same axis as w and the square roots of its two
  // spectral values w_0 +- |w_1..|.
  Vector3d w = 2.0 * (x[0] * x + y[0] * y);
  w[0] = x.squaredNorm() + y.squaredNorm();
  const double t = std::hypot(w[1], w[2]);
  const double large = std::sqrt(w[0] + t), small = std::sqrt(std::max(0.0, w[0] - t));
  Vector3d root(0.5 * (large + small), 0.0, 0.0);
  if (t > 0.0) root.tail<2>() = 0.5 * (large - small) / t * w.tail<2>();
  return root;
}

ContactLinearisation fischer_burmeister_linearised(const Vector3d& r, const Vector3d& u, double mu,
                                                   double rho) {
  ContactLinearisation l;
  if (mu == 0.0) {  // scalar along the normal, r_T = 0
    const double x = r[0], y = rho * u[0], norm = std::hypot(x, y);
    l.f = Vector3d(x + y - norm, r[1], r[2]);
    // Where x and y both vanish F has a corner; 0.3 is about 1 - sqrt(1/2), its slope along x = y.
    l.df_dr(0, 0) = norm > 0.0 ? 1.0 - x / norm : 0.3;
    l.df_du(0, 0) = rho * (norm > 0.0 ? 1.0 - y / norm : 0.3);
    return l;
  }
  // Lorentz's cone: x = (mu r_N, r_T), y = rho (modified u_N / mu, u_T), x . y = rho r . modified u
  const Vector3d to_x(mu, 1.0, 1.0), to_y(rho / mu, rho, rho);
  const Vector3d x = to_x.cwiseProduct(r), y = to_y.cwiseProduct(modified_velocity(u, mu));
  const Vector3d z = jordan_norm(x, y);
  const Vector3d from_x = to_x.cwiseInverse();  // gives F as an impulse in the frame of r
  l.f = from_x.cwiseProduct(x + y - z);
  if (z[0] == 0.0) {  // x = y = 0: the limit along the cone's axis with x = y
    const double slope = 1.0 - std::sqrt(0.5);
    l.df_dr = slope * Matrix3d::Identity();
    l.df_du = slope * from_x.cwiseProduct(to_y).asDiagonal() * modified_velocity_jacobian(u, mu);
    return l;
  }
  // Differentiating z o z = x o x + y o y gives L_z dz = L_x dx + L_y dy. On the cone's boundary
  // L_z is singular, and a small multiple of the identity makes it regular.
  Matrix3d lz = arrow(z);
  const double smallest = z[0] - std::hypot(z[1], z[2]);
  if (smallest < 1e-10 * z[0]) lz += (1e-10 * z[0] + 1e-300) * Matrix3d::Identity();
  const Matrix3d inverse = lz.inverse();
  const Matrix3d by_x = Matrix3d::Identity() - inverse * arrow(x),
                 by_y = Matrix3d::Identity() - inverse * arrow(y);
  l.df_dr = from_x.asDiagonal() * by_x * to_x.asDiagonal();
  l.df_du = from_x.asDiagonal() * by_y * to_y.asDiagonal() * modified_velocity_jacobian(u, mu);
  return l;
}

}  // namespace

ContactLinearisation linearise(ContactEquation equation, const Vector3d& r, const Vector3d& u,
                               double mu, double rho) {
  return equation == ContactEquation::alart_curnier ? alart_curnier_linearised(r, u, mu, rho)
                                                    : fischer_burmeister_linearised(r, u, mu, rho);
}

RegularStep regular_step(double mu, double rho, double epsilon, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u) {
  RegularStep step;
  const double stiffness = rho / epsilon;
  const Eigen::Vector3d z = r - rho * u;
  // Open: the impulse goes to zero.
  if (z[0] <= 0.0) {
    step.source = -r;
    return step;
  }
  if (mu == 0.0) {  // a half-line
    step.source = Eigen::Vector3d(-u[0] * stiffness, -r[1], -r[2]);
    step.gain(0, 0) = stiffness;
    step.status = ContactStatus::stick;
    return step;
  }
  // Stick: u~ + du~ = 0.
  // u~ changes by du + epsilon_c dr, hence dr = -(u~ + du) / epsilon_c: a stiff spring.
  const double t = std::hypot(z[1], z[2]);
  if (t <= mu * z[0]) {
    step.source = -u * stiffness;
    step.gain = stiffness * Eigen::Matrix3d::Identity();
    step.status = ContactStatus::stick;
    return step;
  }
  // Slip: u~_N + du~_N = 0. Along z_T the impulse goes to the disc's edge, which moves with r_N;
  // across z_T it turns as the projection on the disc does. kappa <= 1: else a gain is negative.
  const double e1 = z[1] / t, e2 = z[2] / t, radius = mu * std::max(r[0], 0.0);
  const double kappa = std::min(1.0, radius / t);
  // Across z_T: r + dr = kappa dz with dz = dr - rho (du + epsilon_c dr) and rho epsilon_c =
  // epsilon give (1 - kappa + kappa epsilon) dr = -r - kappa rho du.
  const double turn = 1.0 - kappa + kappa * epsilon, across_gain = kappa * rho / turn;
  const double normal = -u[0] * stiffness;
  const double along = radius - (e1 * r[1] + e2 * r[2]) + mu * normal;
  const double across = -(e1 * r[2] - e2 * r[1]) / turn;
  step.source = Eigen::Vector3d(normal, along * e1 - across * e2, along * e2 + across * e1);
  step.gain << stiffness, 0.0, 0.0,                                        //
      mu * e1 * stiffness, across_gain * e2 * e2, -across_gain * e1 * e2,  //
      mu * e2 * stiffness, -across_gain * e1 * e2, across_gain * e1 * e1;
  step.status = ContactStatus::slip;
  return step;
}

}  // namespace ballast
