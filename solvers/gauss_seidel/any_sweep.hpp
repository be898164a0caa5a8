#pragma once
// Chooses the sweep that fits a problem. DelassusSweep sweeps a stored W along its rows. The sweeps
// over bodies never form W: contacts push bodies, and bodies carry the motion to other contacts.
// WideSweep solves groups of contacts side by side, ScalarSweep contact after contact.

#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "solvers/gauss_seidel/scalar_sweep.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {

class AnySweep {
 public:
  /// Sets the team whose members share a sweep; null: the caller alone. The results have the same
  /// bits whatever the number of members.
  void use_team(WorkerTeam* team) { plan_.use_team(team); }

  /// Chooses the sweep and makes everything that does not depend on the impulses: records, masses,
  /// 1/rho. A problem that has both forms is swept over its bodies.
  void prepare(const FrictionProblem& problem) {
    if (!problem.has_dynamics) {
      stored_.prepare(problem);
      chosen_ = &stored_;
    } else if (plan_.prepare(problem); wide_.prepare(problem)) {
      chosen_ = &wide_;
    } else {
      scalar_.prepare(problem);
      chosen_ = &scalar_;
    }
  }

  ContactSweep* operator->() { return chosen_; }

 private:
  SweepPlan plan_;
  ScalarSweep scalar_{plan_};
  WideSweep wide_{plan_};
  DelassusSweep stored_;
  ContactSweep* chosen_ = &scalar_;
};

}  // namespace ballast
