#pragma once
// What the steps of auto's ways cost (auto.hpp). Counted, not clocked: the same problem takes the
// same turns and gives the same bits on every machine and under every load.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// The unit is one multiplication with its addition in a sweep.
class StepWork {
 public:
  /// As far as sizes tell.
  void count(const FrictionProblem& problem);
  /// The first solver that is prepared for factorisations over bodies knows their `operations`
  /// (Solver::operations). True: that was not known before.
  bool learn(double operations);

  double sweep() const { return sweep_; }
  double mixed_sweep() const;                  ///< with Anderson's mixing
  double burst_step() const { return step_; }  ///< of the regular law
  double newton_step() const;                  ///< of Coulomb's law itself
  double interior_step() const;
  /// A Newton step with a stored W, whose last factorisation took so many operations.
  double stored_step(double operations) const;
  /// Mixed sweeps are taken to need, of what plain ones have had: mixing is cheap with a stored W,
  /// and where a factorisation is dear it is tried before.
  double mixed_after() const { return mixed_after_; }

 private:
  double contacts_ = 0.0, unknowns_ = 0.0;
  bool has_bodies_ = false, is_learnt_ = false;
  double sweep_ = 0.0, step_ = 0.0, mixed_after_ = 0.0;
};

}  // namespace ballast
