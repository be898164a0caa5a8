#pragma once
// The error that a method of sweeps may stop with.

#include "solvers/seam/iteration.hpp"

namespace ballast {

/// Stores the iterate of `sweep` in `r` and returns its error [m/s]. An error small enough to stop
/// is evaluated once more from the impulses alone, as the judge will: thousands of updates have
/// left their rounding in the velocities. `load()` takes `r` into the sweep again.
template <typename Sweep, typename Load>
double swept_error(Sweep& sweep, const FrictionProblem& problem, const Iteration& iteration,
                   Impulses& r, const Load& load) {
  const double error = sweep.error();
  sweep.store(problem, r);
  if (!iteration.reached(error)) return error;
  load();
  return sweep.error();
}

}  // namespace ballast
