#pragma once
// Block Jacobi: every contact solved exactly against the others' last impulses, all at once. The
// parallel baseline.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

std::unique_ptr<Solver> make_jacobi();

}  // namespace ballast
