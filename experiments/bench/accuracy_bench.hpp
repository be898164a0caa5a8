#pragma once
// `ballast bench accuracy`: what a simulated second costs at which error, by solver and limit (the
// closed loop of `ballast compare --live`).

#include <functional>

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/live.hpp"
#include "experiments/page/plot.hpp"

namespace ballast {

struct AccuracyOptions {
  LiveOptions live;  ///< its tolerances: solved to these, with as many iterations as that takes
  std::vector<int> iterations;  ///< and so many in every step
};

/// One solver under one limit, from the common start.
struct AccuracyRow {
  std::string solver, limit;        ///< "200 iterations", "tolerance 0.001"
  double seconds_per_second = 0.0;  ///< wall clock of steps per simulated second
  double error_mean = 0.0,
         error_worst = 0.0;  ///< judge: rms natural map over contacts [g h], over steps
  double iterations = 0.0;   ///< mean
  double distance = 0.0;  ///< rms over grains at the end [m] from the reference: the trajectory of
                          ///< the least mean error; NaN without one
  double penetration = 0.0;  ///< [m] largest
  bool complete = false;
};

/// Throws what run_live throws; `said` hears of each trajectory, returning false stops.
std::vector<AccuracyRow> measure_accuracy(const AccuracyOptions& options,
                                          const std::function<bool(const Trajectory&)>& said);

std::vector<Measurement> accuracy_measurements(const std::vector<AccuracyRow>& rows);

/// Error over cost, a line to each solver.
Figure accuracy_figure(const std::vector<AccuracyRow>& rows);

}  // namespace ballast
