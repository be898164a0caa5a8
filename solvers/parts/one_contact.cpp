#include "solvers/parts/one_contact.hpp"

#include <algorithm>
#include <limits>

namespace ballast {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

}  // namespace

void make_principal(const Eigen::Matrix3d& w, double mu, PrincipalContact& contact,
                    TangentTurn& turn) {
  contact = {};
  turn = {};
  contact.mu = mu;
  const double trace = w.trace();
  if (!(w(0, 0) > 0.25 * rounding * trace)) return;  // no motion along the normal, up to rounding
  contact.inverse_normal = 1.0 / w(0, 0);
  // c = W_TN / W_NN and the tangents' Schur complement S = W_TT - c W_TN^T = (a b; b d).
  const double c1 = w(1, 0) * contact.inverse_normal, c2 = w(2, 0) * contact.inverse_normal;
  const double a = w(1, 1) - c1 * w(1, 0), b = w(2, 1) - c1 * w(2, 0), d = w(2, 2) - c2 * w(2, 0);

  // Eigenvalues middle -+ h; the eigenvector of the larger one is along (delta + h, b) or, the
  // same, (b, h - delta): whichever does not cancel. Selects, not branches: the order of the two is
  // a coin's toss.
  const double middle = 0.5 * (a + d), delta = 0.5 * (a - d), h = std::sqrt(delta * delta + b * b);
  if (h > 0.0) {
    const double inverse_h = 1.0 / h;
    const double large = std::sqrt(0.5 + 0.5 * std::abs(delta) * inverse_h),
                 small = 0.5 * b * inverse_h / large;
    turn.cosine = delta < 0.0 ? large : small;
    turn.sine = delta < 0.0 ? -small : -large;
  }
  contact.s1 = middle - h;
  contact.s2 = middle + h;
  // Where S is singular, or negative by rounding, a W nearer to the given one than its own rounding
  // is solved instead.
  contact.s1 = std::max(contact.s1, rounding * trace);
  contact.s2 = std::max(contact.s2, rounding * trace);
  contact.inverse_s1 = 1.0 / contact.s1;
  contact.inverse_s2 = 1.0 / contact.s2;
  contact.c1 = c1;
  contact.c2 = c2;
  turn.to_principal(contact.c1, contact.c2);
}

ContactStatus solve_one_contact(const Eigen::Matrix3d& w, const Eigen::Vector3d& q, double mu,
                                Eigen::Vector3d& r, double& lambda) {
  PrincipalContact contact;
  TangentTurn turn;
  make_principal(w, mu, contact, turn);
  double q1 = q[1], q2 = q[2];
  turn.to_principal(q1, q2);
  // The impulse that stops all motion, u = 0: y = -q_N / W_NN and r_T = -S^-1 (q_T - c q_N).
  double y = -q[0] * contact.inverse_normal;
  double t1 = -(q1 - contact.c1 * q[0]) * contact.inverse_s1,
         t2 = -(q2 - contact.c2 * q[0]) * contact.inverse_s2;
  double x = lambda > 0.0 ? contact.s1 + lambda : 0.0;
  const ContactStatus status = apply_coulomb(contact, y, t1, t2, x);
  lambda = status == ContactStatus::slip && mu > 0.0 ? x - contact.s1 : 0.0;
  // Back to the given coordinates: r_N = y - c . r_T, and the tangents turned back.
  r[0] = y - contact.c1 * t1 - contact.c2 * t2;
  turn.from_principal(t1, t2);
  r[1] = t1;
  r[2] = t2;
  return status;
}

}  // namespace ballast
