#pragma once
// Primal-dual interior point for the second-order cone problem of contact: Nesterov-Todd scaling,
// Mehrotra's predictor and corrector, one sparse factorisation a step. Acary, Armand, Nguyen,
// Shpakovych 2023, "Second-order cone programming for frictional contact mechanics using interior
// point algorithm". The s-update (slip_shift.hpp) makes the law Coulomb's: an inner problem with s
// held, then a new s, from an iterate that is still well inside. From a stated distance on, or
// where this stalls (the scaling's range ends at rounding), proximal Newton goes the rest of the
// way.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Proximal Newton takes over below the error `polish_from`, in units of the rms of q.
std::unique_ptr<Solver> make_interior_point(double polish_from = 1e-4);

}  // namespace ballast
