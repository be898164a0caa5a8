#pragma once
// One damped Newton step on the contact equations of all contacts, with an optional proximal term
// around a centre; and its linear system.

#include <vector>

#include "solvers/parts/body_matrix.hpp"
#include "solvers/parts/contact_equation.hpp"
#include "solvers/parts/contact_operator.hpp"

namespace ballast {

/// The linear system of a Newton step on all contacts at once:
///
///   by_r dr + by_u du = -f  at every contact,   du = W dr + alpha dr   (alpha: a proximal term, 0
///   for none)
///
/// With the dynamics form the impulses are eliminated, dr = -B^-1 (f + by_u H dv), B = by_r + alpha
/// by_u, and (M + H^T B^-1 by_u H) dv = -H^T B^-1 f is solved in the bodies' velocities: few
/// unknowns, a pattern of bodies that touch.
///
/// With a stored W it is (B + by_u W) dr = -f. A contact that nothing presses has by_u = 0, and its
/// own rows give its dr. The others are a dense system where they are few or W is nearly full, and
/// a sparse one with W's pattern elsewhere.
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

 private:
  bool solve_bodies(const ContactOperator& w, const std::vector<ContactLinearisation>& linear,
                    const std::vector<double>& alpha, Impulses& dr);
  bool solve_idle(const FrictionProblem& problem, const std::vector<ContactLinearisation>& linear,
                  const std::vector<double>& alpha, Impulses& dr);
  bool solve_dense(const FrictionProblem& problem, const std::vector<ContactLinearisation>& linear,
                   Impulses& dr);
  bool solve_sparse(const FrictionProblem& problem, const std::vector<ContactLinearisation>& linear,
                    Impulses& dr);

  // The dynamics form:
  std::vector<Eigen::Matrix3d> gain_;    ///< E = B^-1 by_u per contact
  std::vector<Eigen::Vector3d> source_;  ///< B^-1 f
  BodyMatrix matrix_;
  Eigen::VectorXd right_, dv_, u_;
  // A stored W:
  std::vector<Eigen::Matrix3d> b_;
  std::vector<int> pressed_;  ///< contacts with by_u != 0
  std::vector<int> place_;    ///< of each row among those of pressed contacts; -1: none
  int pressed_rows_ = 0;
  long pressed_entries_ = 0;  ///< of W in their rows
  LuFactor sparse_lu_;
};

/// The iterate (r, u = W r + q) of a Newton method. The residual is that of F(r, u + alpha (r -
/// centre)) = 0.
class NewtonStep {
 public:
  void prepare(const FrictionProblem& problem);
  /// FrontLu::use_team
  void use_team(WorkerTeam* team) { system_.use_team(team); }
  /// Starts at `r`, which is also the centre; contacts that nothing moves lose their impulse.
  void begin(ContactEquation equation, double rho_factor, Impulses r);

  void set_rho_factor(double factor) { rho_factor_ = factor; }
  void set_proximal(double weight);  ///< alpha_c = weight / rho_c
  void centre() { centre_ = r_; }    ///< the centre moves to the iterate
  void restart(const Impulses& r);   ///< the iterate goes (back) to `r`

  /// One factorisation and a backtracking line search on residual(). False: singular, or no
  /// descent; a step without descent is still taken where it changes the residual by less than a
  /// tenth, so that flat places can be left, and taken whole with `halvings` = 0.
  bool newton(int halvings);

  /// rms over contacts of |F_c| / rho_c [m/s].
  double residual() const { return residual_of(r_, u_); }
  /// The judge's error of the iterate [m/s].
  double error() const { return w_.error(r_, u_); }
  const Impulses& impulses() const { return r_; }

 private:
  double residual_of(const Impulses& r, const Eigen::VectorXd& u) const;
  Eigen::Vector3d proximal_velocity(const Impulses& r, const Eigen::VectorXd& u, int c) const;

  ContactOperator w_;
  NewtonSystem system_;
  ContactEquation equation_ = ContactEquation::alart_curnier;
  double rho_factor_ = 1.0;
  std::vector<double> alpha_;
  std::vector<ContactLinearisation> linear_;
  Impulses r_, centre_, dr_, r_trial_;
  Eigen::VectorXd u_, du_, u_trial_;
};

}  // namespace ballast
