#pragma once
// (W + P)^-1 with P block diagonal, symmetric positive definite: the linear system of ADMM (P = the
// penalty) and of the interior point (P = the cone's scaling).
//
// Dynamics form, Sigma = P^-1: in velocity space, sparse and never rank deficient (Woodbury),
//   (W + P)^-1 b = Sigma b - Sigma H (M + H^T Sigma H)^-1 H^T Sigma b
// Stored W: W + P itself is eliminated contact by contact.

#include <vector>

#include "solvers/parts/body_matrix.hpp"
#include "solvers/parts/contact_operator.hpp"

namespace ballast {

class ShiftedDelassus {
 public:
  /// Prepares the parts that do not depend on P. `w` must stay prepared for the same problem.
  void prepare(ContactOperator& w);

  /// P_c [1/kg] of every contact, 3 x 3 symmetric positive definite, and P_c^-1 [kg], which the
  /// caller knows more exactly than an inversion. Set both before factor() and keep them until the
  /// last solve(). Of a one-row contact only entries 0,0 are read.
  std::vector<Eigen::Matrix3d> shift, sigma;
  /// False: singular to working precision; solve() must then not be called.
  bool factor();
  /// x = (W + P)^-1 b, improved `refinements` times by the residual of the whole system. `x` must
  /// not be `b`.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x, int refinements = 0);
  /// See FrontLu::use_team().
  void use_team(WorkerTeam* team) {
    bodies_.use_team(team);
    sum_.use_team(team);
  }

 private:
  void solve_once(const Eigen::VectorXd& b, Eigen::VectorXd& x);

  ContactOperator* w_ = nullptr;
  BodyMatrix bodies_;     ///< dynamics form
  SparseRows h_;          ///< dynamics form
  SparseColumns stored_;  ///< stored W
  FrontLu sum_;           ///< W + P
  Eigen::VectorXd scaled_, body_, contact_, residual_, correction_;
};

}  // namespace ballast
