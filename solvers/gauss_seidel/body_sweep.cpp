#include "solvers/gauss_seidel/body_sweep.hpp"

namespace ballast {

void BodySweep::prepare(const FrictionProblem& problem) {
  plan_.prepare(problem);
  is_wide_ = !variants_ && wide_.prepare(problem);
  if (!is_wide_) scalar_.prepare(problem);
}

void BodySweep::load(const FrictionProblem& problem, const Impulses& r) {
  is_wide_ ? wide_.load(problem, r) : scalar_.load(problem, r);
}

void BodySweep::store(const FrictionProblem& problem, Impulses& r) const {
  is_wide_ ? wide_.store(problem, r) : scalar_.store(problem, r);
}

void BodySweep::sweep() { is_wide_ ? wide_.sweep() : scalar_.sweep(); }

void BodySweep::start_search() { is_wide_ ? wide_.start_search() : scalar_.start_search(); }

double BodySweep::sweep(SearchStep step) {
  return is_wide_ ? wide_.sweep(step) : scalar_.sweep(step);
}

void BodySweep::sweep(const SweepVariant& variant, const std::vector<int>& contacts) {
  scalar_.sweep(variant, contacts);
}

double BodySweep::error() { return is_wide_ ? wide_.error() : scalar_.error(); }

void BodySweep::save(Eigen::VectorXd& state) const {
  is_wide_ ? wide_.save(state) : scalar_.save(state);
}

void BodySweep::restore(const Eigen::VectorXd& state) {
  is_wide_ ? wide_.restore(state) : scalar_.restore(state);
}

void BodySweep::impulse_weights(Eigen::VectorXd& weights) const {
  is_wide_ ? wide_.impulse_weights(weights) : scalar_.impulse_weights(weights);
}

}  // namespace ballast
