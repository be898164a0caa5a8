#pragma once
// The error that a method of sweeps may stop with.

#include "solvers/seam/iteration.hpp"

namespace ballast {

/// Sweeps of a solve with this budget may be in single precision where it pays: casting the records
/// takes as long as a few sweeps in double. Not where the budget asks for another measure, which
/// may stop a solve between two looks of ours.
template <typename Sweep>
void allow_single(Sweep& sweep, const Budget& budget) {
  constexpr int it_pays_from = 16;  // iterations
  if constexpr (requires { sweep.allow_single(true); })
    sweep.allow_single(budget.max_iterations >= it_pays_from && !budget.fclib);
}

/// Stores the iterate of `sweep` in `r` and returns its error [m/s]. An error small enough to stop
/// is evaluated once more from the impulses alone, as the judge will: thousands of updates have
/// left their rounding in the velocities. `load()` takes `r` into the sweep again. Where sweeps
/// were in single precision, the last iterate is swept once more in double: what is returned obeys
/// each contact's law to the rounding of double.
template <typename Sweep, typename Load>
double swept_error(Sweep& sweep, const FrictionProblem& problem, const Iteration& iteration,
                   Impulses& r, const Load& load) {
  double error = sweep.error();
  if constexpr (requires { sweep.finish_in_double(); })
    if (iteration.ends_with(error) && sweep.finish_in_double()) error = sweep.error();
  sweep.store(problem, r);
  if (!iteration.reached(error)) return error;
  load();
  return sweep.error();
}

}  // namespace ballast
