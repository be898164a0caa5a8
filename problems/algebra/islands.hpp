#pragma once
// Islands: the parts of a problem that have nothing to do with one another. Contacts join the
// bodies that can move; what has no unknowns (walls, fixed bodies) joins nothing.

#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// The contacts of each island of a problem in dynamics form, ascending; islands in the order of
/// their first bodies. Contacts between two bodies that cannot move belong to none.
std::vector<std::vector<int>> contact_islands(const FrictionProblem& problem);

}  // namespace ballast
