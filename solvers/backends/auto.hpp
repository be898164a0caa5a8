#pragma once
// The backend that we recommend: sweeps where sweeps are enough, proximal Newton where they are
// not.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Sweeps with conjugate gradients, sweeps with Anderson's mixing, proximal Newton, Newton with
/// bursts of sweeps (where the bodies are known) and an interior point, each from an iterate of its
/// own. It is always the most promising one's turn: by the pace at which its error falls, and at
/// most twice what it has had already, so that none falls far behind. Promises are in work counted
/// from sizes, not clocked (same input, same turns), or in iterations where those are scarce. One
/// iteration is a sweep or a factorisation.
std::unique_ptr<Solver> make_auto();

}  // namespace ballast
