#pragma once
// The slow, simple way: every operator as a dense matrix, written from the header's definitions
// alone.

#include <Eigen/Dense>

#include "problems/algebra/friction_problem.hpp"

namespace ballast::oracle {

Eigen::MatrixXd dense_mass(const FrictionProblem& problem);
Eigen::MatrixXd dense_h(const FrictionProblem& problem);
Eigen::MatrixXd dense_delassus(const FrictionProblem& problem);
Eigen::VectorXd dense_q(const FrictionProblem& problem);

/// Eigen's decompositions, compiled once: x with A x = b, and the eigenvalues of a symmetric A in
/// ascending order.
Eigen::VectorXd dense_solution(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);
Eigen::VectorXd eigenvalues(const Eigen::MatrixXd& a);

/// Three bodies with 6, 3 and 1 unknowns, and contacts of every kind: with two bodies, one body on
/// either side, or none; with one row or three.
FrictionProblem mixed_problem();

}  // namespace ballast::oracle
