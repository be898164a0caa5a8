#pragma once
// The sweep that fits a problem. A stored W is swept along its rows; otherwise contacts push
// bodies, bodies carry the motion to other contacts, and W is never formed: in groups of contacts
// side by side, or contact after contact.

#include "solvers/gauss_seidel/delassus_sweep.hpp"
#include "solvers/gauss_seidel/scalar_sweep.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/gauss_seidel/wide_sweep.hpp"

namespace ballast {

class AnySweep {
 public:
  /// Whose members share a sweep from now on; null: the caller alone. The same bits whatever their
  /// number.
  void use_team(WorkerTeam* team) {
    plan_.use_team(team);
    scalar_.use_team(team);
    wide_.use_team(team);
  }

  /// Chooses, and makes everything that does not depend on the impulses: records, masses, 1/rho. A
  /// problem that has both forms is swept over its bodies.
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
