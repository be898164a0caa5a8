#include "solvers/parts/one_contact.hpp"

namespace ballast {

void make_principal(const Eigen::Matrix3d& w, double mu, PrincipalContact& contact,
                    TangentTurn& turn) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  contact = {};
  turn = {};
  contact.mu = mu;
  const double trace = w.trace();
  if (!(w(0, 0) > 0.25 * rounding * trace)) return;  // no motion along the normal, up to rounding
  contact.inverse_normal = 1.0 / w(0, 0);
  // c = W_TN / W_NN and the tangents' Schur complement S = W_TT - c W_TN^T = (a b; b d).
  const double c1 = w(1, 0) * contact.inverse_normal, c2 = w(2, 0) * contact.inverse_normal;
  const double a = w(1, 1) - c1 * w(1, 0), b = w(2, 1) - c1 * w(2, 0), d = w(2, 2) - c2 * w(2, 0);

  // The eigenvalues are middle -+ h. The eigenvector of the larger one is along (delta + h, b),
  // which is parallel to (b, h - delta); the one without cancellation is taken. Selects replace
  // branches, as the order of the two is unpredictable.
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
  // Where S is singular, or negative by rounding, it is replaced by a regular one, which changes W
  // by less than the rounding of W.
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
  double x = lambda > 0.0 ? contact.s1 + lambda : 0.0;
  r.setZero();
  const ContactStatus status = resolve_contact(contact, turn, q.data(), r.data(), x);
  lambda = status == ContactStatus::slip && mu > 0.0 ? x - contact.s1 : 0.0;
  return status;
}

}  // namespace ballast
