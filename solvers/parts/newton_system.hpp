#pragma once
// The linear system of a Newton step on the contact equations of all contacts.

#include <vector>

#include "solvers/parts/body_matrix.hpp"
#include "solvers/parts/contact_equation.hpp"
#include "solvers/parts/contact_operator.hpp"

namespace ballast {

///   df_dr dr + df_du du = -f  at every contact,   du = W dr
///
/// With the dynamics form the impulses are eliminated, dr = -B^-1 (f + df_du H dv), B = df_dr, and
/// (M + H^T B^-1 df_du H) dv = -H^T B^-1 f is solved for the bodies' velocities: it has few
/// unknowns and entries only between bodies that touch.
///
/// With a stored W it is (B + df_du W) dr = -f. A contact that nothing presses has df_du = 0, and
/// its own rows give its dr. The others form a dense system where they are few or W is nearly full;
/// elsewhere all contacts form a sparse one with W's pattern.
class NewtonSystem {
 public:
  /// Finds the pattern and the places of all blocks. `w` must stay prepared for the same problem.
  void prepare(const ContactOperator& w);

  /// Solves the system above for dr. `linear[c]` per contact. With the dynamics form B must be
  /// regular, as a proximal term makes that of a sticking contact. False: singular.
  bool solve(const std::vector<ContactLinearisation>& linear, Impulses& dr);

  /// Solves dr = source - gain_c du, du = W dr by the same elimination, (M + H^T gain H) dv = H^T
  /// source. `dr` holds the source before, the solution after. `enough`: see BodyMatrix::solve().
  /// Dynamics form only. False: singular, or not finite.
  bool solve_springs(const std::vector<Eigen::Matrix3d>& gain, Impulses& dr, Eigen::VectorXd& du,
                     double enough = 0.0);

  /// See FrontLu::use_team().
  void use_team(WorkerTeam* team) { matrix_.use_team(team); }

 private:
  bool solve_bodies(const std::vector<ContactLinearisation>& linear, Impulses& dr);
  bool solve_idle(const std::vector<ContactLinearisation>& linear, Impulses& dr);
  bool solve_dense(const std::vector<ContactLinearisation>& linear, Impulses& dr);
  bool solve_sparse(const std::vector<ContactLinearisation>& linear, Impulses& dr);

  const ContactOperator* w_ = nullptr;
  // The dynamics form:
  std::vector<Eigen::Matrix3d> gain_;  ///< B^-1 df_du per contact
  BodyMatrix matrix_;
  Eigen::VectorXd right_, dv_, u_;
  // A stored W:
  std::vector<int> pressed_;  ///< contacts with df_du != 0
  std::vector<int> place_;    ///< of each row among those of pressed contacts; -1: none
  int pressed_rows_ = 0;
  long pressed_entries_ = 0;  ///< entries of W in the rows of pressed contacts
  LuFactor sparse_lu_;
};

}  // namespace ballast
