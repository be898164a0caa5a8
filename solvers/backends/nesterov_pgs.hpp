#pragma once
// Gauss-Seidel sweeps with Nesterov's momentum, which begins anew when a sweep changes more than
// the least of its search did. Nesterov 1983, "A method of solving a convex programming problem
// with convergence rate O(1/k^2)"; O'Donoghue, Candes 2015, "Adaptive restart for accelerated
// gradient schemes".

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

struct NesterovSettings {
  /// Where a limit ends it: of the iterates that were looked at the best, swept once more. False:
  /// the last, from which a method goes on whose sweeps are one part of it.
  bool returns_best = true;
};

std::unique_ptr<Solver> make_nesterov_pgs(const NesterovSettings& settings = {});

}  // namespace ballast
