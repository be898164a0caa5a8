#pragma once
// The least that a sweep can take: bytes and floating-point operations counted from the layout of
// its records (solvers/gauss_seidel/group_record.hpp), against what the machine was measured to
// do.

#include "experiments/bench/measurement.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Of one contact in one sweep. The velocities of its two bodies come again at once and stay in a
/// near cache: they are not counted.
struct SweepCost {
  double record_bytes = 0.0;   ///< read once
  double impulse_bytes = 0.0;  ///< read and written: counted twice
  double flops = 0.0;          ///< without the slip branch
  double streamed_bytes() const { return record_bytes + impulse_bytes; }
};
SweepCost friction_cost();  ///< of a contact with friction: three rows
SweepCost one_row_cost();

/// Mean over the problem's contacts; zero without contacts.
SweepCost mean_sweep_cost(const FrictionProblem& problem);

/// What a sweep of the problem touches: records, impulses and body velocities [bytes].
double sweep_working_set(const FrictionProblem& problem);

/// The roofline of a sweep as measurements of the group "floor": its cost, the machine's limits at
/// the working set's size and streaming, and the least time a contact takes by them.
std::vector<Measurement> floor_measurements(const FrictionProblem& problem,
                                            const MachineFacts& facts);

}  // namespace ballast
