#pragma once
// The Delassus operator W = H M^-1 H^T: built only when someone asks for it.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {

/// Diagonal blocks W_cc of every contact, as 3 x 3 (a one-row contact uses only entry 0,0; the rest
/// is zero). Of a stored W the symmetric part: rho and local solves need no more, and a solution
/// does not depend on either.
void delassus_diagonal(const FrictionProblem& problem, std::vector<Eigen::Matrix3d>& blocks);

/// The same with the workspace of a caller that comes every step; `roots` holds the factored masses
/// afterwards.
void delassus_diagonal(const FrictionProblem& problem, std::vector<MassRoot>& roots,
                       std::vector<Eigen::Matrix3d>& blocks);

/// The same of one contact, the masses being factored (dynamics form only).
Eigen::Matrix3d delassus_block(const FrictionProblem& problem, const std::vector<MassRoot>& roots,
                               int c);

/// The whole operator, assembled block by block from contacts that share a body (or the stored
/// one).
SparseRows delassus_matrix(const FrictionProblem& problem);

}  // namespace ballast
