#pragma once
// `ballast bench accuracy`: what a simulated second costs at which error, by solver and limit (the
// closed loop of `ballast compare --live`).

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/live.hpp"

namespace ballast {

/// The closed loop under every tolerance of `live`, with as many iterations as that takes, then
/// with each of `iterations` in every step. The reference is the complete trajectory of the least
/// mean error. `said` hears of each trajectory; returning false stops. Throws what run_live throws.
LiveComparison measure_accuracy(const LiveOptions& live, const std::vector<int>& iterations,
                                const std::function<bool(const Trajectory&)>& said);

/// Of complete trajectories, a group to each: its cost, and all that live.csv holds.
std::vector<Measurement> accuracy_measurements(const LiveComparison& comparison);

/// Error over cost, a line to each solver.
Figure accuracy_figure(const LiveComparison& comparison);

}  // namespace ballast
