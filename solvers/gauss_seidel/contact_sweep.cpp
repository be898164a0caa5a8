#include "solvers/gauss_seidel/contact_sweep.hpp"

namespace ballast {

void ContactSweep::start_search() {
  save(before_);
  direction_.setZero(before_.size());
}

double ContactSweep::sweep_along(SearchStep step) {
  save(swept_);
  before_ = swept_ - before_;  // what the last sweep changed
  direction_ = step.beta * direction_ + step.ahead * before_;
  swept_ += direction_;
  direction_ += step.gain * before_;
  before_ = swept_;
  restore(swept_);
  sweep();
  const Eigen::Index impulses = save(swept_);
  return (swept_ - before_).head(impulses).squaredNorm();
}

}  // namespace ballast
