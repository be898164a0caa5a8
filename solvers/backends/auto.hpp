#pragma once
// The backend that we recommend: sweeps where they are enough, Newton where they are not.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Sweeps with conjugate gradients, sweeps with Anderson's mixing, plain and proximal Newton,
/// Newton with bursts of sweeps (where the bodies are known) and an interior point, each from an
/// iterate of its own. It is always the most promising one's turn: by the pace at which its error
/// falls with its work, and at most a few times what it has had already, so that none falls far
/// behind. Work is counted from sizes and from the fill of the factorisation, not clocked (same
/// input, same turns); where iterations are scarce, they are counted. One iteration is a sweep or a
/// factorisation.
std::unique_ptr<Solver> make_auto();

}  // namespace ballast
