#pragma once
// k_art of a whole jam, statically: the load on the driven wall is held until the wall creeps
// steadily, then raised and lowered by a part p of itself, twice, and the wall's place x (outward)
// is read at the end of each of the four holds.
//
//   1/k_art = (-x_1 + 3 x_2 - 3 x_3 + x_4) / (8 p F)    [m/N]
//
// The weights leave nothing of a creep that goes on by itself, be it steady or slowing down evenly.
// Rigid grains that are solved exactly do not move: 1/k_art = 0, until the jam gives way. The
// answer to one step is jam_stiffness.hpp's; here the solver has all steps of a hold.

#include <vector>

#include "experiments/step/time_step.hpp"

namespace ballast {

struct StaticLoadSettings {
  double force = 0.0;     ///< F [N]
  double part = 0.1;      ///< p
  double settle = 0.04;   ///< simulated under F before anything is measured [s]
  double seconds = 0.01;  ///< simulated in each hold [s]
};

struct StaticLoad {
  double compliance = 0.0;  ///< 1/k_art [m/N]
  // the wall's own residual under the steady load: the second half of that time
  double creep = 0.0;       ///< mean outward velocity [m/s]
  double speed = 0.0;       ///< mean |v| [m/s]
  double error = 0.0;       ///< the judge's rms over contacts, mean [m/s]
  double iterations = 0.0;  ///< mean per step
};

/// From a state of a run, which goes on under the steady load. Throws std::invalid_argument where
/// the system has no driven wall; what TimeStepper throws.
StaticLoad static_load(MechanicalSystem system, const StepSettings& settings, MotionState state,
                       StepMemory memory, const StaticLoadSettings& what);

}  // namespace ballast
