#include "solvers/parts/slip_shift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "problems/algebra/friction_cone.hpp"

namespace ballast {

void Anderson::reset(int memory) {
  memory_ = memory;
  image_steps_.resize(memory);
  residual_steps_.resize(memory);
  gram_.resize(memory, memory);
  next_ = 0;
  forget();
}

void Anderson::step(Eigen::VectorXd& x, const Eigen::VectorXd& image) {
  // The differences are kept in a ring of `memory` places.
  residual_ = image - x;
  if (primed_) {
    if (count_ == 0) next_ = 0;
    image_steps_[next_] = image - last_image_;
    residual_steps_[next_] = residual_ - last_residual_;
    count_ = std::min(count_ + 1, memory_);
    // Of the products of residual differences only those with the newest one are new.
    for (int k = 0; k < count_; ++k)
      gram_(next_, k) = gram_(k, next_) = residual_steps_[next_].dot(residual_steps_[k]);
    next_ = (next_ + 1) % memory_;
  }
  last_image_ = image;
  last_residual_ = residual_;
  primed_ = true;
  x = image;
  if (count_ == 0) return;
  // x := G(x) - sum gamma_k (difference of images)_k, where gamma would leave the least residual if
  // G were linear (Anderson 1965).
  const Eigen::VectorXd gamma = combine();
  if (!gamma.allFinite()) return forget();
  for (int k = 0; k < count_; ++k) x -= gamma[k] * image_steps_[k];
}

/// min |residual - sum gamma_k residual_step_k|, regularised so that steps that hardly differ do
/// not get huge weights.
Eigen::VectorXd Anderson::combine() const {
  Eigen::MatrixXd gram = gram_.topLeftCorner(count_, count_);
  Eigen::VectorXd right(count_), scale(count_);
  for (int k = 0; k < count_; ++k) {
    scale[k] = gram(k, k) > 0.0 ? 1.0 / std::sqrt(gram(k, k)) : 0.0;
    right[k] = scale[k] * residual_steps_[k].dot(residual_);
  }
  gram = scale.asDiagonal() * gram * scale.asDiagonal();
  gram.diagonal().array() += 1e-10;
  return scale.asDiagonal() * gram.ldlt().solve(right);
}

void SlipShift::reset(const ContactOperator& w) {
  s_.setZero(w.contact_count());
  image_.resize(w.contact_count());
  mixing_.reset(8);
  last_distance_ = std::numeric_limits<double>::infinity();
}

/// With this s, u + s n lies in K* exactly where u_N >= 0.
void SlipShift::follow(const ContactOperator& w, const Eigen::VectorXd& u) {
  for (int c = 0; c < w.contact_count(); ++c) s_[c] = w.friction(c) * tangential_norm(w.at(u, c));
}

double SlipShift::distance(const ContactOperator& w, const Eigen::VectorXd& u) const {
  RootMeanSquare mean;
  for (int c = 0; c < w.contact_count(); ++c)
    mean.add(s_[c] - w.friction(c) * tangential_norm(w.at(u, c)));
  return mean.value();
}

double SlipShift::convex_error(const ContactOperator& w, const Impulses& r,
                               const Eigen::VectorXd& u) const {
  RootMeanSquare mean;
  for (int c = 0; c < w.contact_count(); ++c) {
    const double rho = w.rho()[c];
    if (!(rho > 0.0)) continue;
    const Eigen::Vector3d rc = w.at(r, c);
    // One projected gradient step of the convex problem, as a velocity.
    const Eigen::Vector3d step = rc - project_cone(rc - rho * shifted(w, u, c), w.friction(c));
    mean.add_square(step.squaredNorm() / (rho * rho));
  }
  return mean.value();
}

void SlipShift::improve(const ContactOperator& w, const Eigen::VectorXd& u) {
  const double now = distance(w, u);
  for (int c = 0; c < w.contact_count(); ++c)
    image_[c] = w.friction(c) * tangential_norm(w.at(u, c));
  // Past steps mislead once the distance grows: they are forgotten, and the step is plain.
  if (now > 2.0 * last_distance_) mixing_.forget();
  mixing_.step(s_, image_);
  // An extrapolation may overshoot, but s is never negative.
  s_ = s_.cwiseMax(0.0);
  last_distance_ = now;
}

}  // namespace ballast
