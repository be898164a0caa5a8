#pragma once
// Projected (nonsmooth) Gauss-Seidel: contact after contact, each solved exactly (Jean 1999;
// Siconos' NSGS), plain and accelerated.

#include <functional>
#include <memory>

#include "solvers/gauss_seidel/sweep_variant.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

/// The plain variant has the fast loop.
std::unique_ptr<Solver> make_gauss_seidel(const SweepVariant& variant = {});

struct NesterovSettings {
  /// Where a limit ends it: of the iterates that were looked at the best, swept once more. False:
  /// the last, from which a method goes on whose sweeps are one part of it.
  bool returns_best = true;
};

/// Sweeps with Nesterov's momentum, which begins anew when a sweep changes more than the least of
/// its search did. Nesterov 1983, "A method of solving a convex programming problem with
/// convergence rate O(1/k^2)"; O'Donoghue, Candes 2015, "Adaptive restart for accelerated gradient
/// schemes".
std::unique_ptr<Solver> make_nesterov_pgs(const NesterovSettings& settings = {});

/// Nonsmooth nonlinear conjugate gradients: sweeps taken for a gradient, Fletcher-Reeves for the
/// rest. Silcowitz-Hansen, Niebe, Erleben 2010, "A nonsmooth nonlinear conjugate gradient method
/// for interactive contact force problems".
std::unique_ptr<Solver> make_nncg();

/// For Budget::gives_up of sweeps: after `least` of them, where two looks in a row promise that the
/// rest of the way to budget.aim() takes more than `most` others. `budget` outlives it.
std::function<bool(int, double)> slow_sweeps(int least, double most, const Budget& budget);

}  // namespace ballast
