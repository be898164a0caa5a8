#pragma once
// The backend that we recommend: sweeps where sweeps are enough, proximal Newton where they are
// not.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Gauss-Seidel first, in growing rounds. When the rate of the last round says that the tolerance
/// is further away than some factorisations cost, proximal Newton takes over; where that stands
/// still, sweeps and Newton go on by turns from the best iterate. What a sweep and a factorisation
/// cost is modelled from sizes, not clocked: same input, same bits. One iteration is a sweep or a
/// factorisation.
std::unique_ptr<Solver> make_auto();

}  // namespace ballast
