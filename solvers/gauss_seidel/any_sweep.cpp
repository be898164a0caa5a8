#include "solvers/gauss_seidel/any_sweep.hpp"

namespace ballast {

void AnySweep::prepare(const FrictionProblem& problem) {
  if (!problem.has_dynamics) {
    stored_.prepare(problem);
    chosen_ = &stored_;
    return;
  }
  plan_.prepare(problem);
  if (!variants_ && wide_.prepare(problem)) {
    chosen_ = &wide_;
    return;
  }
  scalar_.prepare(problem);
  chosen_ = &scalar_;
}

}  // namespace ballast
