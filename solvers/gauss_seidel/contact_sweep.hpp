#pragma once
// What all Gauss-Seidel sweeps have alike, whatever carries motion from contact to contact: groups
// of contacts side by side (WideSweep), bodies (ScalarSweep), or a stored W (DelassusSweep).

#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/group_kernels.hpp"

namespace ballast {

class ContactSweep {
 public:
  virtual ~ContactSweep() = default;

  /// Takes the impulses; those that move nothing along their contact's normal are dropped.
  virtual void load(const FrictionProblem& problem, const Impulses& r) = 0;
  virtual void store(const FrictionProblem& problem, Impulses& r) const = 0;

  /// Every contact once, in an order of its own.
  virtual void sweep() = 0;
  /// A search along sweeps begins at the current iterate.
  virtual void start_search() = 0;
  /// The iterate moves along the search direction and is then swept. Returns |r after the sweep - r
  /// before it|^2 over contacts, in the sweep's coordinates.
  virtual double sweep_along(SearchStep step) = 0;
  /// The judge's scaled natural map at the current iterate, rms over contacts [m/s].
  virtual double error() = 0;

  // See WideSweep: the others sweep in double in any case.
  virtual void allow_single(bool) {}
  virtual bool finish_in_double() { return false; }
  /// The error, perhaps in single precision; then no iterate can be stored before the next error().
  virtual double rough_error() { return error(); }
  virtual bool is_storable() const { return true; }
};

}  // namespace ballast
