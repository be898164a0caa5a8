#pragma once
// What the judge needs of the dynamics form, in one pass over the contacts' rows H.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/judge_block.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {

/// Of contacts begin <= c < end: their rows of q = bias + H v_free and u = bias + H v [m/s], which
/// have their sizes, and W_cc in the first places of the block. `roots`: of the masses. The same
/// bits as by body_to_contact_velocity() and delassus_block().
void look_at_rows(const FrictionProblem& problem, const std::vector<MassRoot>& roots,
                  const Eigen::VectorXd& v, int begin, int end, Eigen::VectorXd& q,
                  Eigen::VectorXd& u, JudgeBlock& block);

}  // namespace ballast
