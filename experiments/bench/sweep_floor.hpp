#pragma once
// The least that a sweep can take: bytes and floating-point operations counted from the layout of
// its records (solvers/sweep_kernels.hpp), against what the machine was measured to do.

#include "experiments/bench/measurement.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Of one contact with friction in one sweep; a one-row contact is counted with its own.
struct SweepCost {
  double record_bytes = 0.0;   ///< read once: the record
  double impulse_bytes = 0.0;  ///< read and written: counted twice
  double velocity_bytes =
      0.0;  ///< both bodies', read and written; they come again at once and stay in a near cache
  double flops = 0.0;  ///< needed ones, on six-wide rows; without the slip branch's Newton steps
  double executed_flops = 0.0;  ///< on the eight-wide lanes
  double streamed_bytes() const { return record_bytes + impulse_bytes; }
};
SweepCost friction_cost();
SweepCost one_row_cost();

/// Bytes that a sweep of the problem streams, and its flops, per contact; ns at the given bandwidth
/// and flop rate.
struct SweepFloor {
  double bytes = 0.0, flops = 0.0, executed_flops = 0.0;  ///< per contact
  double working_set = 0.0;                               ///< [bytes]
  double bandwidth_ns(double GB_s) const { return bytes / GB_s; }
  double flops_ns(double gflops) const { return executed_flops / gflops; }
};
SweepFloor sweep_floor(const FrictionProblem& problem);

/// The floor in cache and streaming as measurements of the group "floor".
std::vector<Measurement> floor_measurements(const FrictionProblem& problem,
                                            const MachineFacts& facts);

}  // namespace ballast
