#pragma once
// The backend that we recommend: sweeps where sweeps are enough, proximal Newton where they are
// not.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Accelerated sweeps first. Their pace over the later half of what was done says how many more they
/// need; where that is more work than a proximal Newton would take, it takes over; where Newton
/// stands still, sweeps of the other kind go on from the best iterate, and so by turns. What a sweep
/// and a Newton step cost is counted in operations from the problem's own size and entries, never
/// clocked: same input, same bits. One iteration is a sweep or a Newton step.
std::unique_ptr<Solver> make_auto();

}  // namespace ballast
