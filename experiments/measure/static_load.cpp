#include "experiments/measure/static_load.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ballast {

StaticLoad static_load(MechanicalSystem system, const StepSettings& settings, MotionState state,
                       StepMemory memory, const StaticLoadSettings& what) {
  const int wall = system.first_driven_wall();
  if (wall < 0) throw std::invalid_argument("static load: no wall is driven");
  TimeStepper stepper(system, settings, wall);
  // Time is counted in steps of this h.
  state.step = std::lround(state.time / settings.h);
  // One hold: every step is seen with its number and how many there are; returns the wall's place
  // at the end.
  const auto hold = [&](double force, double seconds, const auto& see) {
    const long steps = std::max(2L, std::lround(seconds / settings.h));
    system.bodies[static_cast<size_t>(wall)].wall.load = {force, force, 0.0};
    StepRecord last;
    for (long k = 0; k < steps; ++k) {
      last = stepper.step(state, memory);
      see(k, steps, last);
    }
    return last.wall_x;
  };
  // The steady load, whose second half is measured.
  StaticLoad found;
  double counted = 0.0;
  hold(what.force, what.settle, [&](long k, long steps, const StepRecord& record) {
    if (2 * k < steps) return;
    counted += 1.0;
    found.creep += record.wall_v;
    found.speed += std::abs(record.wall_v);
    found.error += record.error_rms;
    found.iterations += record.iterations;
  });
  for (double* mean : {&found.creep, &found.speed, &found.error, &found.iterations})
    *mean /= counted;
  // Up, down, up, down.
  constexpr double weights[] = {-1.0, 3.0, -3.0, 1.0};
  const double change = what.part * what.force;
  double sign = 1.0;
  for (const double weight : weights) {
    const double place =
        hold(what.force + sign * change, what.seconds, [](long, long, const StepRecord&) {});
    found.compliance += weight * place / (8.0 * change);
    sign = -sign;
  }
  return found;
}

}  // namespace ballast
