#pragma once
// One damped Newton step on the contact equations of all contacts, with an optional proximal term
// around a centre.

#include <vector>

#include "solvers/parts/newton_system.hpp"

namespace ballast {

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

  /// Of one factorisation (NewtonSystem::operations).
  double operations() const { return system_.operations(); }
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
  ContactEquation equation_ = ContactEquation::natural_map;
  double rho_factor_ = 1.0;
  std::vector<double> alpha_;
  std::vector<ContactLinearisation> linear_;
  Impulses r_, centre_, dr_, r_trial_;
  Eigen::VectorXd u_, du_, u_trial_;
};

}  // namespace ballast
