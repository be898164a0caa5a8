#pragma once
// Accelerated projected gradient descent with adaptive restart. Mazhar, Heyn, Negrut, Tasora 2015,
// "Using Nesterov's method to accelerate multibody dynamics with friction and contact"; restart
// after O'Donoghue, Candes 2015. Departures: diagonal scaling by 1 / lambda_max(W_cc); the s-update
// (slip_shift.hpp), so that Coulomb's law is reached and not its convex relaxation; one product
// with W an iteration, backtracking included.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

std::unique_ptr<Solver> make_apgd();

}  // namespace ballast
