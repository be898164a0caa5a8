#pragma once
// Islands: the independent parts of a problem. Contacts join the bodies that can move; bodies
// without unknowns (undriven walls, fixed bodies) join nothing.

#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// Returns the contacts of each island of a problem in dynamics form, ascending. Islands are in the
/// order of their first bodies. Contacts between two bodies that cannot move belong to no island.
std::vector<std::vector<int>> contact_islands(const FrictionProblem& problem);

}  // namespace ballast
