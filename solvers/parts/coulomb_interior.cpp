#include "solvers/parts/coulomb_interior.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "problems/algebra/friction_cone.hpp"

namespace ballast {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The positive numbers p and q with p - q = t and p q = nu, without cancellation.
std::pair<double, double> centred(double t, double nu) {
  const double root = std::sqrt(t * t + 4.0 * nu);
  const double large = 0.5 * (std::abs(t) + root), small = nu / large;
  return t > 0.0 ? std::pair{large, small} : std::pair{small, large};
}

}  // namespace

void CoulombInterior::prepare(const UnitMassContacts& contacts, UnitMassSystem& system) {
  contacts_ = &contacts;
  system_ = &system;
  const int count = contacts.contact_count();
  scaling_.assign(count, Vector3d::Zero());
  for (int c = 0; c < count; ++c) {
    const UnitMassContacts::Contact& k = contacts[c];
    if (!(k.lambda_max > 0.0)) continue;
    const double root = 1.0 / std::sqrt(k.lambda_max);
    // In these units W_cc has the largest eigenvalue one. A half-line has no tangents:
    // zeros keep them out of every sum.
    scaling_[c] = k.half_line ? Vector3d(root, 0.0, 0.0) : Vector3d(root / k.friction, root, root);
  }
  for (ContactColumns* columns : {&r_, &g_, &dr_, &dg_, &gap_, &slope_, &push_})
    columns->setZero(3, count);
  nt_.resize(count);
  inverse_square_.assign(count, Matrix3d::Zero());
  gain_.assign(count, Matrix3d::Zero());
}

void CoulombInterior::begin(const ContactColumns& r, double nu) {
  contacts_->body_velocity(r, x_);
  // Contact by contact the pair (r~, g~) with the difference z = r~ - g~ of the start and the
  // product r~ o g~ = nu 1. Large z_0 gives an impulse, a very negative one a gap.
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    if (!(k.lambda_max > 0.0)) continue;
    const Vector3d& t = scaling_[c];
    Vector3d g = contacts_->relative(x_, c) + k.bias;
    if (k.half_line) {
      const auto [rn, gn] = centred(r(0, c) / t[0] - t[0] * g[0], nu);
      r_.col(c) << rn, 0.0, 0.0;
      g_.col(c) << gn, 0.0, 0.0;
      continue;
    }
    g[0] += k.friction * std::hypot(g[1], g[2]);
    // z = r~ - g~ by its spectral values; r~ and g~ have the same frame.
    const Vector3d z = r.col(c).cwiseQuotient(t) - t.cwiseProduct(g);
    // A vector of Lorentz's cone is a sum over its two spectral values x_0 +- |x_1..|,
    // along (1, +- e) / 2. In them the Jordan product is the product of numbers, and so p -
    // q = t, p q = nu is solved twice.
    const double length = std::hypot(z[1], z[2]);
    const double e1 = length > 0.0 ? z[1] / length : 1.0, e2 = length > 0.0 ? z[2] / length : 0.0;
    const auto [r_plus, g_plus] = centred(z[0] + length, nu);
    const auto [r_minus, g_minus] = centred(z[0] - length, nu);
    r_.col(c) << r_plus + r_minus, e1 * (r_plus - r_minus), e2 * (r_plus - r_minus);
    g_.col(c) << g_plus + g_minus, e1 * (g_plus - g_minus), e2 * (g_plus - g_minus);
    r_.col(c) *= 0.5;
    g_.col(c) *= 0.5;
  }
}

/// What the point lacks: x against x_free + G^T r, and u + s n against g.
void CoulombInterior::measure() {
  other_.setZero(3, contacts_->contact_count());
  for (int c = 0; c < contacts_->contact_count(); ++c)
    other_.col(c) = scaling_[c].cwiseProduct(Vector3d(r_.col(c)));
  contacts_->body_velocity(other_, imbalance_);
  imbalance_ -= x_;
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    if (!(k.lambda_max > 0.0)) continue;
    Vector3d u = contacts_->relative(x_, c) + k.bias;
    slope_.col(c).setZero();
    if (k.half_line) {
      gap_.col(c) << u[0] - g_(0, c) / scaling_[c][0], 0.0, 0.0;
      continue;
    }
    // s = mu |u_T| belongs to this very u. Its slope goes into the matrix: the step is one of
    // Coulomb's law, not of the convex problem with s held.
    const double slip = std::hypot(u[1], u[2]);
    if (slip > 0.0) slope_.col(c) << 0.0, k.friction * u[1] / slip, k.friction * u[2] / slip;
    u[0] += k.friction * slip;
    gap_.col(c) = u - g_.col(c).cwiseQuotient(scaling_[c]);
  }
}

/// Nesterov and Todd's scaling of every contact, and the gains that it makes.
bool CoulombInterior::scale() {
  double sum = 0.0;
  int cones = 0;
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    if (!(k.lambda_max > 0.0)) continue;
    if (!lorentz::scale(r_.col(c), g_.col(c), k.half_line, nt_[c])) return false;
    sum += nt_[c].lambda.squaredNorm();
    ++cones;
    inverse_square_[c] = nt_[c].of_square([](double x) { return 1.0 / x; });
    if (k.half_line) inverse_square_[c] = Vector3d(inverse_square_[c](0, 0), 0.0, 0.0).asDiagonal();
    // For the bodies a contact is a spring: dr = -D J du with D = T F^-2 T and J = 1 + n (ds/du)'.
    // J is what makes the matrix unsymmetric.
    const auto t = scaling_[c].asDiagonal();
    const Matrix3d stiffness = t * inverse_square_[c] * t;
    gain_[c] = stiffness + stiffness.col(0) * slope_.col(c).transpose();
  }
  nu_ = cones > 0 ? sum / cones : 0.0;
  return true;
}

/// c = -lambda o lambda, with the centre's part, and what the predictor has shown of the products.
void CoulombInterior::set_targets(double sigma_nu, bool corrects) {
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    if (!(k.lambda_max > 0.0)) continue;
    const lorentz::Scaling& nt = nt_[c];
    Vector3d target = -lorentz::product(nt.lambda, nt.lambda);
    if (corrects) target -= lorentz::product(nt.f * dr_.col(c), nt.f_inverse * dg_.col(c));
    target[0] += sigma_nu;
    const Vector3d divided = k.half_line ? Vector3d(target[0] / nt.lambda[0], 0.0, 0.0)
                                         : lorentz::divide(nt.lambda, target);
    push_.col(c) = nt.f_inverse * divided;
  }
}

/// The Newton step for the targets: bodies first, and from them g~ and r~.
void CoulombInterior::solve() {
  // dr~ = push - F^-2 dg~ and dg~ = T (gap + J du) with du = G dx leave for the bodies (1 + G' D J
  // G) dx = imbalance + G' T (push - F^-2 T gap).
  right_ = imbalance_;
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    if (!((*contacts_)[c].lambda_max > 0.0)) continue;
    const Vector3d& t = scaling_[c];
    const Vector3d asked =
        push_.col(c) - inverse_square_[c] * t.cwiseProduct(Vector3d(gap_.col(c)));
    contacts_->push(right_, c, t.cwiseProduct(asked));
  }
  system_->solve(right_, dx_);
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    if (!((*contacts_)[c].lambda_max > 0.0)) continue;
    Vector3d du = contacts_->relative(dx_, c);
    du[0] += slope_.col(c).dot(du);
    dg_.col(c) = scaling_[c].cwiseProduct(Vector3d(gap_.col(c) + du));
    dr_.col(c) = push_.col(c) - inverse_square_[c] * dg_.col(c);
  }
}

/// `part` of the longest step that keeps r~ and g~ inside, at most 1.
double CoulombInterior::longest(double part) const {
  double t = 1.0 / part;
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    if (!(k.lambda_max > 0.0)) continue;
    if (!k.half_line) {
      t = lorentz::longest_step(r_.col(c), dr_.col(c), t);
      t = lorentz::longest_step(g_.col(c), dg_.col(c), t);
      continue;
    }
    if (dr_(0, c) < 0.0) t = std::min(t, -r_(0, c) / dr_(0, c));
    if (dg_(0, c) < 0.0) t = std::min(t, -g_(0, c) / dg_(0, c));
  }
  return std::min(1.0, part * t);
}

double CoulombInterior::step(double part) {
  measure();
  if (!scale() || !system_->factor(gain_)) return 0.0;
  // The predictor shows how much of the way is free; the less, the more the corrector centres.
  set_targets(0.0, false);
  solve();
  const double blocked = 1.0 - longest(1.0);
  set_targets(std::clamp(blocked * blocked * blocked, 1e-8, 1.0) * nu_, true);
  solve();
  if (!dx_.allFinite()) return 0.0;
  const double length = longest(part);
  // One length for all: what is linear in the equations then keeps
  // the part 1 - length of its error.
  x_ += length * dx_;
  r_ += length * dr_;
  g_ += length * dg_;
  return length;
}

double CoulombInterior::round(ContactColumns& rounded) {
  rounded.setZero(3, contacts_->contact_count());
  other_.setZero(3, contacts_->contact_count());
  // An interior point has both r and g inside their cones, while in an answer r . g =
  // 0. P_K(r) keeps small impulses; P_K(r - rho g) is the judge's own projection, and
  // drops those of contacts that open.
  for (int c = 0; c < contacts_->contact_count(); ++c) {
    const UnitMassContacts::Contact& k = (*contacts_)[c];
    if (!(k.lambda_max > 0.0)) continue;
    const Vector3d r = scaling_[c].cwiseProduct(Vector3d(r_.col(c)));
    const Vector3d g = k.half_line ? Vector3d(g_(0, c) / scaling_[c][0], 0.0, 0.0)
                                   : Vector3d(g_.col(c).cwiseQuotient(scaling_[c]));
    rounded.col(c) = project_cone(r, k.friction);
    other_.col(c) = project_cone(Vector3d(r - g / k.lambda_max), k.friction);
  }
  contacts_->body_velocity(rounded, rounded_x_);
  const double first = contacts_->error(rounded, rounded_x_);
  contacts_->body_velocity(other_, rounded_x_);
  const double second = contacts_->error(other_, rounded_x_);
  if (second < first) std::swap(rounded, other_);
  return std::min(first, second);
}

}  // namespace ballast
