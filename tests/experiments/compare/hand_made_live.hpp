#pragma once
// A closed-loop comparison made by hand: two steps each, one grain, a wall at 1 mm and 2 mm.

#include <Eigen/Dense>

#include "experiments/compare/live.hpp"

namespace ballast {

/// `shift`: distance of the grain and of the wall from the reference's [m].
inline Trajectory hand_made_trajectory(const char* solver, double tolerance, double shift) {
  Trajectory t;
  t.solver = solver;
  t.law = "coulomb";
  t.tolerance = tolerance;
  t.ended = Trajectory::complete;
  for (int k = 1; k <= 2; ++k) {
    StepRecord step;
    step.time = 1e-3 * k;
    step.wall_x = 1e-3 * k + shift;
    step.wall_force = 10.0 * k;
    step.error_rms = 1e-4 * k;
    step.penetration_max = 1e-6 * k;
    step.kinetic_energy = 0.5 * k;
    step.energy_residual = 0.25;
    step.solid_fraction = 0.6;
    step.iterations = 10.0 * k;
    step.seconds_solve = 1e-3 * k;
    t.steps.push_back(step);
    t.frame_times.push_back(step.time);
    t.positions.push_back(Eigen::Vector3d(shift, 0.0, 0.0));
  }
  return t;
}

/// A reference, a looser trajectory that is 3 µm away, and one without steps.
inline LiveComparison hand_made_live() {
  LiveComparison live;
  live.scene.name = "hand & made";
  live.velocity_scale = 1e-2;
  live.has_driven_wall = true;
  live.trajectories = {hand_made_trajectory("pgs", 1e-1, 0.0),
                       hand_made_trajectory("nncg", 1.5e-2, 3e-6),
                       hand_made_trajectory("sap", 1e-2, 0.0)};
  Trajectory& none = live.trajectories[2];
  none.steps.clear();
  none.frame_times.clear();
  none.positions.clear();
  none.ended = "failed: <no words>";
  return live;
}

}  // namespace ballast
