#include "solvers/gauss_seidel/sweep_variant.hpp"

#include <algorithm>

#include "problems/algebra/friction_cone.hpp"

namespace ballast {
namespace {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

/// W_cc with principal tangents: W_NN, W_TN = c W_NN, W_TT = S + c W_NN c^T.
Matrix principal_block(const PrincipalContact& contact) {
  const Vector c(1.0, contact.c1, contact.c2);
  Matrix w = c * c.transpose() / contact.inverse_normal;
  w(1, 1) += contact.s1;
  w(2, 2) += contact.s2;
  return w;
}

/// Alart-Curnier: F_N = r_N - max(0, r_N - rho u_N),  F_T = r_T - P_disc(r_T - rho u_T), the disc
/// of radius mu max(0, r_N - rho u_N). With u = u_0 + W (r - r_0) this returns F and dF/dr.
Vector alart_curnier(const Matrix& w, double mu, double rho, const Vector& r, const Vector& u,
                     Matrix& jacobian) {
  const double pressed = r[0] - rho * u[0], radius = mu * std::max(0.0, pressed);
  const Vector x = r - rho * u;
  const double length = tangential_norm(x);
  Matrix by_r = Matrix::Zero(), by_x = Matrix::Zero();  // of the projected point
  Vector projected = Vector::Zero();
  if (pressed > 0.0) {
    projected[0] = pressed;
    by_x(0, 0) = 1.0;
  }
  if (length <= radius) {
    projected.tail<2>() = x.tail<2>();
    by_x.bottomRightCorner<2, 2>().setIdentity();
  } else if (radius > 0.0) {
    const Eigen::Vector2d direction = x.tail<2>() / length;
    projected.tail<2>() = radius * direction;
    by_x.bottomRightCorner<2, 2>() =
        radius / length * (Eigen::Matrix2d::Identity() - direction * direction.transpose());
    by_x.block<2, 1>(1, 0) = mu * direction;
  }
  // x = r - rho u and du = W dr, hence dx/dr = 1 - rho W.
  by_r = by_x * (Matrix::Identity() - rho * w);
  jacobian = Matrix::Identity() - by_r;
  return r - projected;
}

/// False: Newton has not come to the contact's solution.
bool newton(const Matrix& w, double mu, double rho, const Vector& u0, Vector& r) {
  constexpr int most_steps = 30, most_halvings = 8;
  constexpr double enough = 1e-13;  // relative
  const Vector r0 = r;
  const double scale = r0.norm() + rho * u0.norm();
  Matrix jacobian;
  Vector f = alart_curnier(w, mu, rho, r, u0, jacobian);
  for (int step = 0; step < most_steps; ++step) {
    if (f.norm() <= enough * scale) return true;
    const Vector direction = jacobian.partialPivLu().solve(f);
    if (!direction.allFinite()) return false;
    const Vector before = r;
    const double norm = f.norm();
    // Halved until |F| falls; after the last halving the step is taken whether it does or not.
    double length = 1.0;
    for (int k = 0; k < most_halvings; ++k, length *= 0.5) {
      r = before - length * direction;
      f = alart_curnier(w, mu, rho, r, u0 + w * (r - r0), jacobian);
      if (f.norm() < norm) break;
    }
  }
  return f.norm() <= enough * scale;
}

void solve_exactly(const PrincipalContact& contact, const double* u, double* y, double& slip) {
  y[0] -= u[0] * contact.inverse_normal;
  y[1] -= u[1] * contact.inverse_s1;
  y[2] -= u[2] * contact.inverse_s2;
  apply_coulomb(contact, y[0], y[1], y[2], slip);
}

}  // namespace

void resolve_by_variant(const SweepVariant& variant, const PrincipalContact& contact,
                        double lambda_max, const double* u, double* y, double& slip) {
  if (!(contact.inverse_normal > 0.0)) {  // always open
    y[0] = y[1] = y[2] = 0.0;
    return;
  }
  const auto impulse = [&contact](const double* x) {
    return Vector(x[0] - contact.c1 * x[1] - contact.c2 * x[2], x[1], x[2]);
  };
  // From the coordinates of the record to (r, u), where the other rules are written.
  const Vector before = impulse(y),
               velocity(u[0], u[1] + contact.c1 * u[0], u[2] + contact.c2 * u[0]);
  Vector after = before;
  bool solved = false;
  if (variant.rule == LocalRule::projection) {
    after = project_cone(before - modified_velocity(velocity, contact.mu) / lambda_max, contact.mu);
    solved = true;
  } else if (variant.rule == LocalRule::newton) {
    solved = newton(principal_block(contact), contact.mu, 1.0 / lambda_max, velocity, after);
  }
  if (!solved) {
    double exact[3] = {y[0], y[1], y[2]};
    solve_exactly(contact, u, exact, slip);
    after = impulse(exact);
  }
  // Beyond the solution, or short of it, and back onto the cone.
  if (variant.relaxation != 1.0)
    after = project_cone(before + variant.relaxation * (after - before), contact.mu);
  y[0] = after[0] + contact.c1 * after[1] + contact.c2 * after[2];
  y[1] = after[1];
  y[2] = after[2];
}

}  // namespace ballast
