#pragma once
// What problem files hold, before it becomes a FrictionProblem: matrices and vectors in the
// format's own shape.

#include <vector>

#include "platform/error.hpp"
#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// What is wrong with a problem file; what() starts with the file's name and names the group,
/// dataset and entry.
class ProblemFileError : public Error {
 public:
  using Error::Error;
};

/// work(), with every Error of it (a file that cannot be read or written) as a ProblemFileError.
template <typename Work>
auto with_problem_file_errors(const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    throw ProblemFileError(error.what());
  }
}

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

/// How a global problem divides: body b has unknowns dof_begin[b] .. dof_begin[b+1], contact c is
/// between body_a[c] and body_b[c] (-1: nothing that moves) and has the first rows[c] of its rows.
struct Division {
  std::vector<int> dof_begin{0}, body_a, body_b, rows;
};

/// The dynamics form by a division that fits the matrices' sizes; entries that it has no place for
/// are left out. v_free remains to be set.
FrictionProblem divided(const GlobalProblem& global, const Division& division);

/// Rows of the problem as three per contact, tangents of one-row contacts being zero, and back.
Eigen::VectorXd three_rows(const FrictionProblem& problem, const Eigen::VectorXd& x);
Eigen::VectorXd own_rows(const FrictionProblem& problem, const Eigen::VectorXd& wide);

/// Of the dynamics form. One-row contacts become three rows with mu = 0, of which two are empty.
GlobalProblem to_global_problem(const FrictionProblem& problem);

/// The local form of any problem: W is built where only bodies are known. One-row contacts as
/// above.
LocalProblem condensed(const FrictionProblem& problem);

}  // namespace ballast
