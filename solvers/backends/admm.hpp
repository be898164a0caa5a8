#pragma once
// Alternating directions with over-relaxation and adaptive penalty. Boyd et al. 2011; for contact:
// Acary, Bremond, Huber 2018 (ADMM in Siconos). One sparse factorisation serves all iterations with
// one penalty; the s-update (slip_shift.hpp) makes the law Coulomb's.

#include "solvers/seam/solver.hpp"

namespace ballast {

std::unique_ptr<Solver> make_admm();

}  // namespace ballast
