#include "experiments/paper/wall_model.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {
namespace {

/// Where the wall stands in its cycle.
/// jammed_before -> out -> turning -> in -> jammed_after; what turns may also go out again.
enum class ModelPhase { jammed_before, out, turning, in, jammed_after };

struct Moving {
  double x = 0.0, v = 0.0;
};

double packing_force(const WallModel& model, ModelPhase phase, double x) {
  return phase == ModelPhase::out ? model.active.at(x) : model.passive.at(x + model.contraction);
}

/// One step of Heun's rule (second order) with the force law of a phase.
Moving advanced(const WallModel& model, ModelPhase phase, const Moving& from, double t, double dt) {
  // m_w dv/dt = f_g(x) - f(t), outwards positive.
  const auto acceleration = [&](double x, double time) {
    return (packing_force(model, phase, x) - model.load.at(time)) / model.wall_mass;
  };
  const double a = acceleration(from.x, t);
  const Moving guess{from.x + dt * from.v, from.v + dt * a};
  const double b = acceleration(guess.x, t + dt);
  return {from.x + 0.5 * dt * (from.v + guess.v), from.v + 0.5 * dt * (a + b)};
}

/// A wall at rest leaves when the load lets it, or is pushed in.
ModelPhase released(const WallModel& model, ModelPhase phase, double x, double load) {
  // At rest the packing bears the load as long as it need not push out with more than active(x),
  // nor give way inwards to more than passive(x).
  const bool can_go_out = load < model.active.at(x);
  if (phase == ModelPhase::jammed_before) return can_go_out ? ModelPhase::out : phase;
  if (phase == ModelPhase::jammed_after) return phase;
  if (load > model.passive.at(x + model.contraction)) return ModelPhase::in;
  return can_go_out ? ModelPhase::out : ModelPhase::turning;
}

}  // namespace

ModelMotion integrate(const WallModel& model, int parts) {
  const double dt = 1.0 / (model.load.frequency * parts);
  ModelMotion motion;
  ModelPhase phase = ModelPhase::jammed_before;
  Moving wall;
  for (int k = 0; k <= parts; ++k) {
    const double t = k * dt, load = model.load.at(t);
    // at rest the load decides whether it leaves, and which way
    const bool rests = phase != ModelPhase::out && phase != ModelPhase::in;
    if (rests) phase = released(model, phase, wall.x, load);
    const bool moves = phase == ModelPhase::out || phase == ModelPhase::in;
    motion.time.push_back(t);
    motion.x.push_back(wall.x);
    motion.v.push_back(wall.v);
    motion.force.push_back(moves ? packing_force(model, phase, wall.x) : load);
    motion.rise = std::max(motion.rise, wall.x);
    motion.speed_in = std::max(motion.speed_in, -wall.v);
    if (!moves) continue;
    // one step on; where the velocity changes its sign the wall stops, and where it comes back to
    // its jamming position it stays
    wall = advanced(model, phase, wall, t, dt);
    if ((phase == ModelPhase::out && wall.v <= 0.0) || (phase == ModelPhase::in && wall.v >= 0.0)) {
      phase = ModelPhase::turning;
      wall.v = 0.0;
    }
    if (phase == ModelPhase::in && wall.x <= -model.contraction) {
      wall = {-model.contraction, 0.0};
      phase = ModelPhase::jammed_after;
      motion.jams = true;
    }
  }
  return motion;
}

}  // namespace ballast
