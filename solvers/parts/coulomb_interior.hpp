#pragma once
// An interior point on Coulomb's law itself, in the bodies' unknowns. De Saxce's form of the law,
//
//   K_mu contains r,   g = u + s n in the dual cone,   r . g = 0,   s = mu |u_T|
//
// is a cone program but for s. Where others hold s and come back to it, here s is in the Newton
// system, which is then not symmetric. So it is all or nothing: it ends quadratically, or its steps
// shrink to nothing. It knows no statuses, passes between the branches of the law, and so gets to
// places that a Newton method on statuses does not reach.
//
// Scaled for Lorentz's cone by T = diag(1/mu, 1, 1) / sqrt(lambda_max): r = T r~, g = T^-1 g~.

#include <vector>

#include "solvers/parts/nesterov_todd.hpp"
#include "solvers/parts/unit_mass_system.hpp"

namespace ballast {

class CoulombInterior {
 public:
  /// Both must outlive the use; the system is factored anew in every step.
  void prepare(const UnitMassContacts& contacts, UnitMassSystem& system);

  /// The point near the impulses `r` at which every contact is centred: r~ o g~ = nu 1. `nu` > 0
  /// [J].
  void begin(const ContactColumns& r, double nu);
  /// One factorisation: Mehrotra's predictor and corrector, `part` of the way to the boundary. The
  /// length of the step, at most 1; 0: it broke down.
  double step(double part);
  /// The better of two ways to the cones from here, P_K(r) and P_K(r - rho g). Returns its error
  /// [m/s].
  double round(ContactColumns& rounded);

 private:
  void measure();
  bool scale();
  void set_targets(double sigma_nu, bool corrects);
  void solve();
  double longest(double part) const;

  const UnitMassContacts* contacts_ = nullptr;
  UnitMassSystem* system_ = nullptr;
  std::vector<Eigen::Vector3d> scaling_;  ///< diagonal of T; zero where nothing moves
  ContactColumns r_, g_, dr_, dg_;        ///< scaled: r~, g~ and their steps
  ContactColumns gap_;                    ///< u + s n - g [m/s]
  ContactColumns slope_;                  ///< ds/du: mu u_T / |u_T|
  ContactColumns push_;                   ///< F^-1 (lambda \ c): what the targets ask of r~
  Eigen::VectorXd x_, imbalance_, right_, dx_;
  std::vector<lorentz::Scaling> nt_;
  std::vector<Eigen::Matrix3d> inverse_square_, gain_;  ///< F^-2 and D J
  double nu_ = 0.0;
  ContactColumns other_;
  Eigen::VectorXd rounded_x_;
};

}  // namespace ballast
