#pragma once
// One Moreau-Jean step (theta = 1/2; docs/theory/method.md): half a step of motion, detection, one
// friction problem, half a step of motion.
//
//   q_m = q_k + h/2 v_k                     contacts are detected at the mid-point q_m
//   M (v_{k+1} - v_k) = h f(t_m) + H^T r    with Signorini-Coulomb's law between r and u_{k+1}
//   q_{k+1} = q_m + h/2 v_{k+1}

#include <memory>
#include <string>
#include <vector>

#include "experiments/step/impact_law.hpp"
#include "experiments/step/overlap_correction.hpp"
#include "experiments/step/step_record.hpp"
#include "geometry/contact/contact_detector.hpp"
#include "problems/mechanics/assemble.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {

/// Tolerances are quoted relative to this velocity [m/s]: g h, or 1 m/s where there is no gravity.
double velocity_scale(const Scene& scene);

/// Throws Error naming time [s] and solver where the impulses are not finite: no step can follow.
void require_finite(const SolverRun& run, const std::string& solver, double time);

/// Steps one system. Its motion is held by the caller, in a MotionState and a StepMemory.
class TimeStepper {
 public:
  /// Reads step, gravity, solver, detection, correction and bodies' sizes of the scene.
  /// `driven_wall`: the wall that the record reports (-1: none). Throws UnknownSolver,
  /// MissingSolver.
  TimeStepper(const MechanicalSystem& system, const Scene& scene, int driven_wall);

  /// Advances `state` by h. Throws InvalidProblem when the state has become NaN or infinite, and
  /// Error where a body spins too fast for h; the state is then left in the middle of the step.
  StepRecord step(MotionState& state, StepMemory& memory);

  /// The last problem and its solution, for capture and export. StepMemory has its contacts.
  const FrictionProblem& problem() const { return assembler_.problem(); }
  const Impulses& impulses() const { return impulses_; }
  const ProblemAssembler& assembler() const { return assembler_; }
  /// The impulses from which its solve started, in the rows of the problem. `memory`: of that step.
  void warm_start(const StepMemory& memory, Impulses& rows) const {
    assembler_.to_rows(carried_, memory.contacts, rows);
  }
  const DetectionCounters& detection_counters() const { return detector_.counters(); }
  /// The team, for work between steps; null: there is one thread.
  WorkerTeam* team() const { return team_.get(); }

 private:
  /// Calls task(body) for every body; the team shares the work.
  template <typename Task>
  void for_bodies(const Task& task) {
    run_each(team_.get(), static_cast<int>(system_.bodies.size()), /*together=*/64, task);
  }
  /// The free velocities, which are stored in the problem.
  Eigen::VectorXd& v_free() { return assembler_.problem().dynamics.v_free; }
  void free_motion(int b, const MotionState& state, double mid_time);
  void begin_problem(const MotionState& state, const StepMemory& memory, double mid_time);
  void detect(const MotionState& mid, std::vector<ContactPoint>& contacts);
  void solve(StepMemory& memory, StepRecord& record);
  void account_energy(StepRecord& record);
  void account_contacts(const StepMemory& memory, StepRecord& record);
  void finish_motion(double end_time, MotionState& state);

  const MechanicalSystem& system_;
  double h_, velocity_scale_;
  SolverSpec spec_;
  int driven_wall_;
  std::unique_ptr<WorkerTeam> team_;  // null: one thread
  TeamPace detect_pace_, solve_pace_;
  ContactDetector detector_;
  ProblemAssembler assembler_;
  OverlapCorrection correction_;
  std::unique_ptr<Solver> solver_;
  SolverRunner runner_;
  ImpactLaw impact_law_;

  Impulses impulses_;
  // Per body, stored apart from the bodies so that less memory is read.
  std::vector<double> radius_;
  std::vector<Vec3> inertia_, spin_after_;  ///< `spin_after_`: after a free flight
  std::vector<double> reach_;
  const bool some_shape_is_fixed_;  ///< then bodies may pass edges that would not stop them
  std::vector<Pose> ahead_;         ///< poses at the next detection if nothing is met
  std::vector<ContactPoint> old_contacts_;
  std::vector<Vec3> old_impulses_, carried_;
  Eigen::VectorXd v_before_;
  Eigen::VectorXd force_, gyroscopic_;  // h f, and the impulse of the gyroscopic term
};

}  // namespace ballast
