#include "solvers/parts/regular_newton.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/root_mean_square.hpp"

namespace ballast {

void RegularNewton::prepare(const FrictionProblem& problem) {
  contacts_.prepare(problem);
  system_.prepare(contacts_);
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
  return contacts_.error(at.r, at.x);
}

void RegularNewton::set_centre(const ContactColumns& centre, double epsilon) {
  centre_ = centre;
  epsilon_ = epsilon;
  has_status_ = false;
}

/// u + epsilon_c (r - centre)
Eigen::Vector3d RegularNewton::velocity(const NewtonIterate& at, int c) const {
  const UnitMassContacts::Contact& k = contacts_[c];
  const double compliance = epsilon_ * k.lambda_max;
  return contacts_.relative(at.x, c) + k.bias + compliance * (at.r.col(c) - centre_.col(c));
}

double RegularNewton::residual(const NewtonIterate& at) const {
  RootMeanSquare mean;
  // The judge's measure with u~ in place of u.
  for (int c = 0; c < contacts_.contact_count(); ++c) {
    const UnitMassContacts::Contact& k = contacts_[c];
    if (!(k.lambda_max > 0.0)) continue;
    const double value =
        ContactJudge::scaled_natural_map(at.r.col(c), velocity(at, c), k.friction, k.lambda_max);
    mean.add(value);
  }
  return mean.value();
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

bool RegularNewton::step(NewtonIterate& change) {
  // With dr = source - gain G dx the bodies' dx = G^T dr becomes (1 + G^T gain G) dx = G^T source.
  right_ = Eigen::VectorXd::Zero(contacts_.unknown_count());
  for (int c = 0; c < contacts_.contact_count(); ++c) contacts_.push(right_, c, source_.col(c));
  // The bodies' step, and from it the impulses'.
  if (!system_.factor(gain_)) return false;
  system_.solve(right_, change.x);
  if (!change.x.allFinite()) return false;
  change.r = source_;
  for (int c = 0; c < contacts_.contact_count(); ++c)
    if (status_[c] != ContactStatus::open)
      change.r.col(c).noalias() -= gain_[c] * contacts_.relative(change.x, c);
  return true;
}

}  // namespace ballast
