#pragma once
// The backend that we recommend: sweeps where they are enough, Newton where they are not.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Sweeps with momentum come first, and are left where the rest of their way promises to cost more
/// than a dozen Newton steps. Then comes Newton: with bursts of sweeps over bodies, by proximal
/// steps where W alone is known or iterations are scarce. What is then still unsolved is for turns
/// of sweeps, an interior point and Newton, each from the best iterate, for as much work as the
/// others', and twice that in the next turn, until two turns in a row gain nothing.
///
/// Work is counted from sizes, never clocked: the same problem takes the same turns and gives the
/// same bits on every machine. One iteration is a sweep or a factorisation.
std::unique_ptr<Solver> make_auto();

}  // namespace ballast
