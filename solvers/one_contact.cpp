#include "solvers/one_contact.hpp"

#include <algorithm>
#include <limits>

namespace ballast {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon();

}  // namespace

void make_principal(const Eigen::Matrix3d& w, double mu, PrincipalContact& contact, TangentTurn& turn) {
  contact = {};
  turn = {};
  contact.mu = mu;
  const double trace = w.trace();
  if (!(w(0, 0) > 0.25 * rounding * trace)) return;  // no motion along the normal, up to rounding
  contact.inverse_normal = 1.0 / w(0, 0);
  const double c1 = w(1, 0) * contact.inverse_normal, c2 = w(2, 0) * contact.inverse_normal;
  const double a = w(1, 1) - c1 * w(1, 0), b = w(2, 1) - c1 * w(2, 0), d = w(2, 2) - c2 * w(2, 0);

  // Eigenvalues middle -+ h; the eigenvector of the larger one is along (delta + h, b) or, the same, (b, h - delta): whichever
  // does not cancel. Selects, not branches: the order of the two is a coin's toss.
  const double middle = 0.5 * (a + d), delta = 0.5 * (a - d), h = std::sqrt(delta * delta + b * b);
  if (h > 0.0) {
    const double inverse_h = 1.0 / h;
    const double large = std::sqrt(0.5 + 0.5 * std::abs(delta) * inverse_h), small = 0.5 * b * inverse_h / large;
    turn.cosine = delta < 0.0 ? large : small;
    turn.sine = delta < 0.0 ? -small : -large;
  }
  contact.s1 = middle - h;
  contact.s2 = middle + h;
  // Where S is singular, or negative by rounding, a W nearer to the given one than its own rounding is solved instead.
  contact.s1 = std::max(contact.s1, rounding * trace);
  contact.s2 = std::max(contact.s2, rounding * trace);
  contact.inverse_s1 = 1.0 / contact.s1;
  contact.inverse_s2 = 1.0 / contact.s2;
  contact.c1 = c1;
  contact.c2 = c2;
  turn.to_principal(contact.c1, contact.c2);
}

// Slip: u_N = 0 and u_T = -lambda r_T give (S + lambda) r_T = -b and r_N = y - c . r_T. With x = s1 + lambda, x1 = x,
// x2 = x + s2 - s1 and beta = -b / y (so r_T,i = y beta_i / x_i), the unknown is the root of
//
//   psi(x) = mu r_N / |r_T| - 1 = mu N / R - 1,   N = x1 x2 - c1 beta1 x2 - c2 beta2 x1,   R = |(beta1 x2, beta2 x1)|.
//
// psi is linear in x when s1 = s2, and nearly so otherwise: Newton needs few steps.
//
// Bracket. At x = s1 (lambda = 0) the solution is the stick one, which is outside the cone: psi < 0. For larger x,
// |r_T| <= y |beta| / x, hence r_N >= y - |c| |r_T|, and mu r_N >= |r_T| as soon as |r_T| (1 + mu |c|) <= mu y, that is
// from x = |beta| (1 + mu |c|) / mu on: psi >= 0. psi is continuous for x >= s1 > 0 (R = 0 means b = 0, which sticks),
// so a root lies between. With much friction there may be several; each of them obeys Coulomb's law.
void slide(const PrincipalContact& contact, double y, double& t1, double& t2, double& x) {
  const double mu = contact.mu;
  if (!(mu > 0.0)) {
    t1 = t2 = 0.0;
    return;
  }
  const double inverse_y = 1.0 / y;
  const double beta1 = contact.s1 * t1 * inverse_y, beta2 = contact.s2 * t2 * inverse_y;
  const double spread = contact.s2 - contact.s1;
  const double square1 = beta1 * beta1, square2 = beta2 * beta2, square = square1 + square2;
  const double coupling1 = contact.c1 * beta1, coupling2 = contact.c2 * beta2, coupling = coupling1 + coupling2;

  double low = contact.s1;
  double high = std::sqrt(square * (1.0 + mu * mu * (contact.c1 * contact.c1 + contact.c2 * contact.c2)) * 2.0) / mu;
  if (!(x > low && x < high)) x = std::sqrt(square) / mu + coupling - spread * square2 / square;  // exact when s1 = s2
  if (!(x > low && x < high)) x = std::sqrt(low * high);
  double x2 = x + spread;
  for (int step = 0; step < 200; ++step) {
    const double n = x * x2 - coupling1 * x2 - coupling2 * x;
    const double r_square = square1 * x2 * x2 + square2 * x * x;
    const double slope = (x + x2 - coupling) * r_square - n * (square1 * x2 + square2 * x);
    const double gap = std::sqrt(r_square) - mu * n;  // > 0: lambda is too small
    if (gap > 0.0)
      low = x;
    else
      high = x;
    double next = x + gap * r_square / (mu * slope);
    // Newton's error is squared: after so short a step the next one would be below rounding.
    const bool last = std::abs(next - x) <= 1e-9 * x;
    if (!last && !(next > low && next < high)) next = std::sqrt(low * high);
    const bool closed = !(high - low > 4.0 * rounding * high);
    x = next;
    x2 = x + spread;
    if (last || closed) break;
  }
  const double scale = y / (x * x2);
  t1 = beta1 * x2 * scale;
  t2 = beta2 * x * scale;
}

ContactStatus solve_one_contact(const Eigen::Matrix3d& w, const Eigen::Vector3d& q, double mu, Eigen::Vector3d& r,
                                double& lambda) {
  PrincipalContact contact;
  TangentTurn turn;
  make_principal(w, mu, contact, turn);
  double q1 = q[1], q2 = q[2];
  turn.to_principal(q1, q2);
  double y = -q[0] * contact.inverse_normal;
  double t1 = -(q1 - contact.c1 * q[0]) * contact.inverse_s1, t2 = -(q2 - contact.c2 * q[0]) * contact.inverse_s2;
  double x = lambda > 0.0 ? contact.s1 + lambda : 0.0;
  const ContactStatus status = apply_coulomb(contact, y, t1, t2, x);
  lambda = status == ContactStatus::slip && mu > 0.0 ? x - contact.s1 : 0.0;
  r[0] = y - contact.c1 * t1 - contact.c2 * t2;
  turn.from_principal(t1, t2);
  r[1] = t1;
  r[2] = t2;
  return status;
}

}  // namespace ballast
