#pragma once
// The linear system of a Newton step on all contacts at once:
//
//   by_r dr + by_u du = -f  at every contact,   du = W dr + alpha dr      (alpha: a proximal term,
//   0 for none)
//
// With the dynamics form the impulses are eliminated, dr = -B^-1 (f + by_u H dv), B = by_r + alpha
// by_u, and (M + H^T B^-1 by_u H) dv = -H^T B^-1 f is solved in the bodies' velocities: few
// unknowns, a pattern of bodies that touch. With a stored W it is (B + by_u W) dr = -f.

#include <vector>

#include "solvers/parts/body_matrix.hpp"
#include "solvers/parts/contact_equation.hpp"
#include "solvers/parts/contact_operator.hpp"
#include "solvers/parts/newton_matrix.hpp"

namespace ballast {

class NewtonSystem {
 public:
  /// Pattern and positions of all blocks. `w` has been prepared for the problem.
  void prepare(const ContactOperator& w);

  /// dr of the system above. `linear[c]` per contact; `alpha` [1/kg] per contact, > 0 with the
  /// dynamics form (there B must be regular, and at a sticking contact by_r = 0). False: a singular
  /// matrix.
  bool solve(const ContactOperator& w, const std::vector<ContactLinearisation>& linear,
             const std::vector<double>& alpha, Impulses& dr);

  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { matrix_.use_team(team); }
  /// Of a factorisation over bodies (FrontLu::operations); with a stored W of the last one
  /// (NewtonMatrix::operations).
  double operations() const { return operations_; }

 private:
  bool solve_bodies(const ContactOperator& w, const std::vector<ContactLinearisation>& linear,
                    const std::vector<double>& alpha, Impulses& dr);

  std::vector<Eigen::Matrix3d> gain_;    ///< E = B^-1 by_u per contact
  std::vector<Eigen::Vector3d> source_;  ///< B^-1 f
  BodyMatrix matrix_;
  NewtonMatrix matrix_form_;  ///< where W is stored
  double operations_ = 0.0;
  Eigen::VectorXd right_, dv_, u_;
};

}  // namespace ballast
