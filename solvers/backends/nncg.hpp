#pragma once
// Nonsmooth nonlinear conjugate gradients: Gauss-Seidel sweeps taken for a gradient,
// Fletcher-Reeves for the rest. Silcowitz-Hansen, Niebe, Erleben 2010, "A nonsmooth nonlinear
// conjugate gradient method for interactive contact force problems".

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

std::unique_ptr<Solver> make_nncg();

}  // namespace ballast
