#pragma once
// The interface of all Gauss-Seidel sweeps (any_sweep.hpp).

#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"

namespace ballast {

class ContactSweep {
 public:
  virtual ~ContactSweep() = default;

  /// Takes the impulses. The impulse of a contact that no impulse moves along its normal becomes 0.
  virtual void load(const FrictionProblem& problem, const Impulses& r) = 0;
  virtual void store(const FrictionProblem& problem, Impulses& r) const = 0;

  /// Solves every contact once, in an order that the sweep chooses.
  virtual void sweep() = 0;
  /// Begins a search along sweeps at the current iterate.
  virtual void start_search() = 0;
  /// Moves the iterate along the search direction, then sweeps it. Returns |r after the sweep - r
  /// before it|^2 over contacts, in the sweep's coordinates.
  virtual double sweep_along(SearchStep step) = 0;
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  virtual double error() = 0;

  // See WideSweep. The other sweeps are always in double.
  virtual void allow_single(bool) {}
  virtual bool is_single() const { return false; }
  /// The error, perhaps in single precision. Then is_storable() is false until the next error().
  virtual double rough_error() { return error(); }
  virtual bool is_storable() const { return true; }
};

}  // namespace ballast
