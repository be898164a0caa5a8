#pragma once
// Coulomb's law of one contact, regularised, and linearised for the status of the iterate.

#include "problems/algebra/friction_cone.hpp"

namespace ballast {

/// The linearised law: dr = source - gain du for a change du of the contact's velocity.
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
