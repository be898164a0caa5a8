#include "solvers/parts/slip_shift.hpp"

#include <limits>

#include "problems/algebra/root_mean_square.hpp"

namespace ballast {

void SlipShift::reset(const ContactOperator& w, int memory) {
  s_.setZero(w.contact_count());
  image_.resize(w.contact_count());
  mixing_.reset(memory);
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

double SlipShift::improve(const ContactOperator& w, const Eigen::VectorXd& u) {
  const double now = distance(w, u);
  for (int c = 0; c < w.contact_count(); ++c)
    image_[c] = w.friction(c) * tangential_norm(w.at(u, c));
  // Past steps mislead once the distance grows: the plain step, afresh.
  if (now > 2.0 * last_distance_) mixing_.forget();
  mixing_.step(s_, image_);
  // An extrapolation may overshoot; no speed is negative.
  s_ = s_.cwiseMax(0.0);
  last_distance_ = now;
  return now;
}

}  // namespace ballast
