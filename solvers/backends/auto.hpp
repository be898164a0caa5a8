#pragma once
// The backend that we recommend: sweeps where they are enough, Newton where they are not.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Sweeps with momentum, sweeps with Anderson's mixing, plain and proximal Newton, Newton with
/// bursts of sweeps (where the bodies are known), an interior point, and where W is stored sweeps
/// with conjugate gradients. Each is a solve of its own that pauses and goes on as if it had not
/// (paused_solve.hpp). It is always the most promising one's turn: by the
/// pace at which its error falls with its work, and at most a few times what it has had already, so
/// that none falls far behind. Work is counted from sizes and from what factorisations take, not
/// clocked (step_work.hpp: same input, same turns); where iterations are scarce, they are counted.
/// One iteration is a sweep or a factorisation.
std::unique_ptr<Solver> make_auto();

}  // namespace ballast
