#pragma once
// The Delassus operator W = H M^-1 H^T: built only on request.

#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/algebra/mass_root.hpp"

namespace ballast {

/// Computes the diagonal block W_cc of every contact as 3 x 3 (a one-row contact uses only entry
/// 0,0; the rest is zero). A stored W gives the symmetric part: rho and local solves need no more,
/// and a solution depends on neither.
void delassus_diagonal(const FrictionProblem& problem, std::vector<Eigen::Matrix3d>& blocks);

/// The same with the workspace of a caller that returns every step; afterwards `roots` holds the
/// factored masses.
void delassus_diagonal(const FrictionProblem& problem, std::vector<MassRoot>& roots,
                       std::vector<Eigen::Matrix3d>& blocks);

/// The block of one contact, from factored masses (dynamics form only).
Eigen::Matrix3d delassus_block(const FrictionProblem& problem, const std::vector<MassRoot>& roots,
                               int c);

/// The whole operator: the stored one, or assembled block by block from contacts that share a body.
SparseRows delassus_matrix(const FrictionProblem& problem);

}  // namespace ballast
