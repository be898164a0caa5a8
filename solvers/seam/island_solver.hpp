#pragma once
// A backend, island by island.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Solves each island of a problem (problems/islands.hpp) as a problem of its own, one after the
/// other, by `backend`. A problem of one island, and one without a dynamics form, goes through as
/// it is: the same bits as without.
///
/// The tolerance is each island's own: the rms over its contacts. Hence the rms over all contacts,
/// which the judge takes of the whole problem, is met as well, and what an island's impulses are
/// does not depend on what else is in the scene. max_iterations is each island's, max_seconds that
/// of all together.
///
/// Of several islands: `reason` is the worst of theirs, `iterations` their mean weighted by
/// contacts, rounded up (what a sweep over all contacts would be), `own_residual` the rms over all
/// contacts; no history; prepare() is done within solve().
std::unique_ptr<Solver> make_island_solver(std::unique_ptr<Solver> backend);

}  // namespace ballast
