#pragma once
// Accelerated sweeps as long as they promise to arrive; then Newton steps on Coulomb's law of all
// contacts, regularised, with every contact's status guessed and the linear systems solved exactly,
// and bursts of sweeps between them; then proximal-point steps by Newton alone (newton.hpp). So one
// backend serves loose and tight tolerances.
//
// What each part is for: a Newton step carries impulses across the whole packing, as far as the
// statuses that it guessed are right; sweeps put statuses right, contact by contact. From an error
// of about 1e-4 of the start's, proximal-point steps by Newton alone are the faster.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

struct NewtonBurstSettings {
  int start_sweeps = 500;  ///< before the first Newton step, at least; 0: none
  /// Newton's turn comes where sweeps promise to need more than so many others: in
  /// time about twenty Newton steps of some thousand contacts.
  int promised_sweeps = 6000;
  int burst = 200;  ///< sweeps after a Newton step, at most
  /// The end begins with proximal steps that lower the error: at most so many Newton steps, none
  /// where that is 0. They are the faster where nothing jams, and lost where something does.
  int descent_steps = 60;
  /// What they leave is for a walk: proximal steps that may pass through worse places, which come
  /// out of jams. At most so many Newton steps.
  int most_steps = 1000;
  int inner_steps = 10;  ///< before the walk: Newton steps after which a proximal step has failed
};

/// Iterations count sweeps and factorisations alike. Needs the dynamics form.
std::unique_ptr<Solver> make_newton_burst(const NewtonBurstSettings& settings = {});

}  // namespace ballast
