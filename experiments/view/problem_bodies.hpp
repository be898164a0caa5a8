#pragma once
// The bodies of a captured problem without the run that it is from: what the problem itself knows.

#include <vector>

#include "experiments/record/record_file.hpp"
#include "experiments/view/view_data.hpp"
#include "problems/files/captured_problem.hpp"

namespace ballast {

/// Where a contact point is, seen from the centre of mass of one of its bodies (`of_b`: the second)
/// [m, world frame]. Zero where the problem does not tell: a body that does not turn, or a contact
/// without friction, whose one row of H is too little.
Vec3 lever_of(const CapturedProblem& captured, int contact, bool of_b);

/// Bodies that turn have their centre of mass, a ball of their mass and inertia, and the hull of
/// that ball and their contact points. What does not turn is a wall where all its contacts have one
/// normal, else a hull too. `contacts`: the problem's own; the view has them by its own bodies.
ViewData bodies_of_problem(const CapturedProblem& captured, std::vector<FrameContact> contacts);

}  // namespace ballast
