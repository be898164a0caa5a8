#include "solvers/parts/regular_newton.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {

RegularStep regular_step(const RegularContact& contact, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u) {
  RegularStep step;
  const double rho = 1.0 / contact.lambda_max, mu = contact.friction,
               stiffness = rho / contact.epsilon;
  const Eigen::Vector3d z = r - rho * u;
  // Open: the impulse goes to zero.
  if (z[0] <= 0.0) {
    step.source = -r;
    return step;
  }
  if (contact.half_line) {
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
  // Slip: u~_N + du~_N = 0; along z_T the impulse goes to the disc's edge, which moves with r_N;
  // across it turns as the projection on the disc turns. kappa <= 1: else a gain would be negative.
  const double e1 = z[1] / t, e2 = z[2] / t, radius = mu * std::max(r[0], 0.0);
  const double kappa = std::min(1.0, radius / t);
  // Across z_T: r + dr = kappa dz with dz = dr - rho (du + epsilon_c dr) and rho epsilon_c =
  // epsilon give (1 - kappa + kappa epsilon) dr = -r - kappa rho du.
  const double turn = 1.0 - kappa + kappa * contact.epsilon, across_gain = kappa * rho / turn;
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

void RegularNewton::prepare(const FrictionProblem& problem) {
  contacts_.prepare(problem);
  matrix_.prepare(contacts_);
  gain_.resize(contacts_.contact_count());
  source_.resize(3, contacts_.contact_count());
  status_.resize(contacts_.contact_count());
}

NewtonIterate RegularNewton::iterate(const Impulses& r) const {
  NewtonIterate at;
  contacts_.from_impulses(r, at.r);
  contacts_.body_velocity(at.r, at.x);
  return at;
}

double RegularNewton::settle(NewtonIterate& at) const {
  // A Newton step may leave the cones; what is judged lies in them.
  contacts_.project(at.r);
  contacts_.body_velocity(at.r, at.x);
  return contacts_.error(at.r, [&](int c) { return contacts_.velocity(at.x, c); });
}

void RegularNewton::set_centre(const ContactColumns& centre, double epsilon) {
  centre_ = centre;
  epsilon_ = epsilon;
  has_status_ = false;
}

/// u + epsilon_c (r - centre)
Eigen::Vector3d RegularNewton::velocity(const NewtonIterate& at, int c) const {
  const double compliance = epsilon_ * contacts_[c].lambda_max;
  return contacts_.velocity(at.x, c) + compliance * (at.r.col(c) - centre_.col(c));
}

double RegularNewton::residual(const NewtonIterate& at) const {
  return contacts_.error(at.r, [&](int c) { return velocity(at, c); });
}

int RegularNewton::linearise(const NewtonIterate& at) {
  int changed = 0;
  for (int c = 0; c < contacts_.contact_count(); ++c) {
    const UnitMassContacts::Contact& k = contacts_[c];
    RegularStep law;
    if (k.lambda_max > 0.0)
      law = regular_step({k.friction, k.lambda_max, epsilon_, k.half_line}, at.r.col(c),
                         velocity(at, c));
    else  // nothing moves: no impulse
      law.source = -at.r.col(c);
    // A step is exact for the statuses that it was made for; where many change it means little.
    changed += has_status_ && law.status != status_[c];
    status_[c] = law.status;
    source_.col(c) = law.source;
    gain_[c] = law.gain;
  }
  has_status_ = true;
  return changed;
}

/// (I + G^T gain G) x = right_, improved by its residual, once, where that is larger than 1e-10 of
/// the right-hand side: there are no pivots.
void RegularNewton::improve(Eigen::VectorXd& x) {
  // What is left, by way of the contacts: cheaper than the matrix.
  rest_ = right_ - x;
  for (int c = 0; c < contacts_.contact_count(); ++c)
    if (!gain_[c].isZero(0.0)) contacts_.push(rest_, c, -(gain_[c] * contacts_.relative(x, c)));
  if (!(rest_.norm() > 1e-10 * right_.norm())) return;
  matrix_.solve_once(rest_, rest_);
  x += rest_;
}

bool RegularNewton::step(NewtonIterate& change) {
  // With dr = source - gain G dx the bodies' dx = G^T dr becomes (1 + G^T gain G) dx = G^T source.
  right_ = Eigen::VectorXd::Zero(contacts_.unknown_count());
  for (int c = 0; c < contacts_.contact_count(); ++c) contacts_.push(right_, c, source_.col(c));
  if (!matrix_.factor(gain_)) return false;
  matrix_.solve_once(right_, change.x);
  improve(change.x);
  if (!change.x.allFinite()) return false;
  change.r = source_;
  for (int c = 0; c < contacts_.contact_count(); ++c)
    if (status_[c] != ContactStatus::open)
      change.r.col(c).noalias() -= gain_[c] * contacts_.relative(change.x, c);
  return true;
}

}  // namespace ballast
