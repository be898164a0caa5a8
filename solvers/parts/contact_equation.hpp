#pragma once
// Coulomb's law at one contact as a nonsmooth equation F(r, u) = 0, with an element of its
// generalised Jacobian.
//
// Both forms of F vanish exactly where (u, r) obeys Signorini-Coulomb, for every rho > 0 [kg]; F is
// an impulse [N s].

#include <Eigen/Dense>

namespace ballast {

enum class ContactEquation {
  alart_curnier,  ///< normal: half-line; tangential: disc of radius mu (r_N - rho u_N)+   (Alart,
                  ///< Curnier 1991)
  fischer_burmeister  ///< x + y - (x^2 + y^2)^(1/2) in the Jordan algebra of Lorentz's cone
                      ///< (Fukushima, Luo, Tseng 2002)
};

struct ContactLinearisation {
  Eigen::Vector3d f;
  Eigen::Matrix3d df_dr;  ///< dF/dr [-]
  Eigen::Matrix3d df_du;  ///< dF/du [kg]
};

/// F and its derivatives (exact wherever F is differentiable). One-row contacts are padded with
/// zeros; mu = 0 is the half-line, r_T = 0.
ContactLinearisation linearise(ContactEquation equation, const Eigen::Vector3d& r,
                               const Eigen::Vector3d& u, double mu, double rho);

}  // namespace ballast
