#pragma once
// What problem files hold, before it becomes a FrictionProblem: matrices and vectors in the
// format's own shape.

#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// u = W r + q, three rows per contact.
struct LocalProblem {
  SparseRows w;
  Eigen::VectorXd q;
  std::vector<double> mu;
};

/// M v = H r + f, u = H^T v + w: H is unknowns x contact rows, the transpose of ours.
struct GlobalProblem {
  Eigen::SparseMatrix<double> m, h;
  Eigen::VectorXd f, w;
  std::vector<double> mu;
};

inline std::vector<double> as_vector(const Eigen::VectorXd& x) {
  return {x.data(), x.data() + x.size()};
}
inline Eigen::VectorXd as_eigen(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

FrictionProblem to_friction_problem(LocalProblem local);

/// Keeps the dynamics form when the unknowns can be grouped into bodies of six, or of three, so
/// that M is block diagonal and a contact touches at most two of them; one unknown may be left for
/// a last body. Forms W otherwise. Throws InvalidProblem when M is not symmetric positive definite.
FrictionProblem to_friction_problem(const GlobalProblem& global);

/// Rows of the problem as three per contact, tangents of one-row contacts being zero, and back.
Eigen::VectorXd three_rows(const FrictionProblem& problem, const Eigen::VectorXd& x);
Eigen::VectorXd own_rows(const FrictionProblem& problem, const Eigen::VectorXd& wide);

/// One-row contacts become three rows with mu = 0: their tangential rows of W or H are zero.
LocalProblem to_local_problem(const FrictionProblem& problem);
GlobalProblem to_global_problem(const FrictionProblem& problem);

/// The local form of any problem: W is built where only bodies are known.
LocalProblem condensed(const FrictionProblem& problem);

}  // namespace ballast
