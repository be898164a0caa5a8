#pragma once
// The exact solution of one contact: given W (3 x 3, symmetric positive definite) and q, find r
// with u = W r + q and Coulomb's law.

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "problems/algebra/friction_cone.hpp"

namespace ballast {

/// W of one contact in coordinates in which it is diagonal. With c = W_TN / W_NN, the tangents are
/// turned to the principal axes of the Schur complement S = W_TT - c W_TN^T, and y = r_N + c . r_T
/// replaces r_N:
///
///   u_N = W_NN y + q_N,     u_T - c u_N = S r_T + b,   S = diag(s1, s2),   b = q_T - c q_N
///
/// Coulomb's law is the same in the turned tangents. A singular W is replaced by the nearest
/// regular one (relative rounding).
struct PrincipalContact {
  double inverse_normal =
      0.0;  ///< 1 / W_NN [kg]; 0: no impulse moves the contact along its normal, it is always open
  double s1 = 0.0, s2 = 0.0;  ///< 0 < s1 <= s2 [1/kg]
  double inverse_s1 = 0.0, inverse_s2 = 0.0;
  double c1 = 0.0, c2 = 0.0;
  double mu = 0.0;

  double coupling_square() const { return c1 * c1 + c2 * c2; }
};

/// The turn from the given tangents to the principal ones.
struct TangentTurn {
  double cosine = 1.0, sine = 0.0;

  void to_principal(double& t1, double& t2) const {
    const double first = cosine * t1 + sine * t2;
    t2 = cosine * t2 - sine * t1;
    t1 = first;
  }
  void from_principal(double& t1, double& t2) const {
    const double first = cosine * t1 - sine * t2;
    t2 = sine * t1 + cosine * t2;
    t1 = first;
  }
};

/// `w` is symmetric positive semidefinite; for a one-row contact only W_NN is not zero.
void make_principal(const Eigen::Matrix3d& w, double mu, PrincipalContact& contact,
                    TangentTurn& turn);

/// The slip branch: moves from the stick solution (y, t1, t2), which is outside the cone, to |r_T|
/// = mu r_N with the same y. `x` = s1 + lambda: in, a guess (0: none); out, the root. It is defined
/// here because the sweeps compile it for several instruction sets.
//
// Slip: u_N = 0 and u_T = -lambda r_T give (S + lambda) r_T = -b and r_N = y - c . r_T. With x = s1
// + lambda, x1 = x, x2 = x + s2 - s1 and d = -b (so r_T,i = d_i / x_i), the unknown is the root of
//
//   psi(x) = mu r_N / |r_T| - 1 = mu N / R - 1,   N = y x1 x2 - c1 d1 x2 - c2 d2 x1,   R = |(d1 x2,
//   d2 x1)|.
//
// psi is linear in x when s1 = s2, and nearly so otherwise: Newton needs few steps.
//
// Bracket. At x = s1 (lambda = 0) the solution is the stick one, which is outside the cone: psi <
// 0. For larger x, |r_T| <= |d| / x, hence r_N >= y - |c| |r_T|, and mu r_N >= |r_T| as soon as
// |r_T| (1 + mu |c|) <= mu y, that is from x = |d| (1 + mu |c|) / (mu y) on: psi >= 0. psi is
// continuous for x >= s1 > 0 (R = 0 means b = 0, which sticks), so a root lies between. With much
// friction there may be several; each of them obeys Coulomb's law.
inline void slide(const PrincipalContact& contact, double y, double& t1, double& t2, double& x) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr double beyond =
      1e80;  // where d / x counts as zero, as y is nearly zero; powers of a larger x would overflow
  const double mu = contact.mu;
  if (!(mu > 0.0)) {
    t1 = t2 = 0.0;
    return;
  }
  const double d1 = contact.s1 * t1, d2 = contact.s2 * t2, spread = contact.s2 - contact.s1;
  const double square1 = d1 * d1, square2 = d2 * d2, square = square1 + square2;
  const double coupling1 = contact.c1 * d1, coupling2 = contact.c2 * d2,
               coupling = coupling1 + coupling2;

  double low = contact.s1, high = infinity;  // high: the bracket's upper end, once known
  if (!(x > low))
    x = (std::sqrt(square) / mu + coupling) / y - spread * square2 / square;  // exact when s1 = s2
  if (!(x > low)) x = low * (1.0 + 8.0 * rounding);
  if (x >= beyond) {
    t1 = t2 = x = 0.0;
    return;
  }
  double x2 = x + spread;
  for (int step = 0; step < 200; ++step) {
    const double n = y * x * x2 - coupling1 * x2 - coupling2 * x;
    const double r_square = square1 * x2 * x2 + square2 * x * x;
    const double slope = (y * (x + x2) - coupling) * r_square - n * (square1 * x2 + square2 * x);
    const double gap = std::sqrt(r_square) - mu * n;  // > 0: lambda is too small
    if (gap > 0.0)
      low = x;
    else
      high = x;
    double next = x + gap * (r_square / (mu * slope));
    // Newton squares its error: after a step this short the next one would be below rounding.
    const bool last = std::abs(next - x) <= 1e-9 * x;
    if (!last && !(next > low && next < high)) {
      if (high == infinity)
        high =
            std::min(beyond, 2.0 * std::sqrt(square * (1.0 + mu * mu * contact.coupling_square())) /
                                 (mu * y));
      next = std::sqrt(low * high);
    }
    x = next;
    x2 = x + spread;
    if (last || !(low * (1.0 + 4.0 * rounding) < high)) break;
  }
  const double scale = 1.0 / (x * x2);
  t1 = d1 * x2 * scale;
  t2 = d2 * x * scale;
}

/// Tries open, stick and slip in this order. In: the impulse (y, r_T) that would stop all motion;
/// out: the solution. Inlined into the sweeps.
inline ContactStatus apply_coulomb(const PrincipalContact& contact, double& y, double& t1,
                                   double& t2, double& x) {
  if (y <= 0.0) {  // q_N >= 0: the contact opens without an impulse
    y = t1 = t2 = 0.0;
    return ContactStatus::open;
  }
  const double limit = contact.mu * (y - contact.c1 * t1 - contact.c2 * t2);
  if (limit >= 0.0 && t1 * t1 + t2 * t2 <= limit * limit) return ContactStatus::stick;
  slide(contact, y, t1, t2, x);
  return ContactStatus::slip;
}

/// Solves one contact while all others are held. In: its impulse r and the velocity u that all
/// impulses together give it, in the given tangents; out: r. `slip`: the last slip root, kept for
/// the next visit.
inline ContactStatus resolve_contact(const PrincipalContact& contact, const TangentTurn& turn,
                                     const double* velocity, double* r, double& slip) {
  double u1 = velocity[1], u2 = velocity[2], t1 = r[1], t2 = r[2];
  turn.to_principal(u1, u2);
  turn.to_principal(t1, t2);
  double y = r[0] + contact.c1 * t1 + contact.c2 * t2 - velocity[0] * contact.inverse_normal;
  t1 -= (u1 - contact.c1 * velocity[0]) * contact.inverse_s1;
  t2 -= (u2 - contact.c2 * velocity[0]) * contact.inverse_s2;
  const ContactStatus status = apply_coulomb(contact, y, t1, t2, slip);
  r[0] = y - contact.c1 * t1 - contact.c2 * t2;
  turn.from_principal(t1, t2);
  r[1] = t1;
  r[2] = t2;
  return status;
}

/// Solves one contact as open, stick, or slip by a bracketed one-dimensional root; slide() has the
/// proof of the bracket.
///   open : q_N >= 0                        -> r = 0
///   stick: r = -W^-1 q lies in K_mu        -> u = 0
///   slip : u_N = 0, u_T = -lambda r_T, |r_T| = mu r_N, lambda > 0
/// `lambda`: in, a guess (0: none); out, the slip root [1/kg]. The scaled natural map is at most
/// 1e-12 (|q| + lambda_max(W) |r|), for every SPD W and mu >= 0: u = W r + q itself cannot be
/// evaluated more exactly than the rounding of its largest term.
ContactStatus solve_one_contact(const Eigen::Matrix3d& w, const Eigen::Vector3d& q, double mu,
                                Eigen::Vector3d& r, double& lambda);

}  // namespace ballast
