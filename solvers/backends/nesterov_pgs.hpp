#pragma once
// Gauss-Seidel sweeps with Nesterov's momentum, which begins anew when a sweep changes more than
// the least of its search did. Nesterov 1983, "A method of solving a convex programming problem
// with convergence rate O(1/k^2)"; O'Donoghue, Candes 2015, "Adaptive restart for accelerated
// gradient schemes".

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

std::unique_ptr<Solver> make_nesterov_pgs();

}  // namespace ballast
