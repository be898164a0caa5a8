#pragma once
// Coulomb's law at one contact for Newton's method: as a nonsmooth equation F(r, u) = 0 with an
// element of its generalised Jacobian, or regularised and linearised.
//
// Both forms of F vanish exactly where (u, r) obeys Signorini-Coulomb, for every rho > 0 [kg]; F is
// an impulse [N s].

#include "problems/algebra/friction_cone.hpp"

namespace ballast {

enum class ContactEquation {
  alart_curnier,  ///< normal: half-line; tangential: disc of radius mu (r_N - rho u_N)+   (Alart,
                  ///< Curnier 1991)
  fischer_burmeister  ///< x + y - (x^2 + y^2)^(1/2) in the Jordan algebra of Lorentz's cone
                      ///< (Fukushima, Luo, Tseng 2002)
};

/// As it is made, F is zero and r has to stay.
struct ContactLinearisation {
  Eigen::Vector3d f = Eigen::Vector3d::Zero();
  Eigen::Matrix3d df_dr = Eigen::Matrix3d::Identity();  ///< dF/dr [-]
  Eigen::Matrix3d df_du = Eigen::Matrix3d::Zero();      ///< dF/du [kg]
};

/// F and its derivatives (exact wherever F is differentiable). One-row contacts are padded with
/// zeros; mu = 0 is the half-line, r_T = 0.
ContactLinearisation linearise(ContactEquation equation, const Eigen::Vector3d& r,
                               const Eigen::Vector3d& u, double mu, double rho);

/// The regularised law, linearised: dr = source - gain du for a change du of the velocity.
struct RegularStep {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  ContactStatus status = ContactStatus::open;
};

/// Linearises the regularised law at the impulse `r`, where `u` is
///
///   u~ = u + epsilon_c (r - centre),   epsilon_c = epsilon / rho
///
/// The regularised law has compliance epsilon_c around the centre and is solvable whatever W's
/// rank; where r is the centre it is the law itself. The status follows from z = r - rho u~ with
/// the contact's natural scale rho = 1 / lambda_max(W_cc): with 1 / epsilon_c instead, hundreds of
/// contacts would change at once. After Alart, Curnier 1991, with the disc mu r_N for the
/// tangential impulse. epsilon > 0, and rho > 0. A one-row contact is one without friction.
RegularStep regular_step(double mu, double rho, double epsilon, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u);

}  // namespace ballast
