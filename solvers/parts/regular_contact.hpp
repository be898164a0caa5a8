#pragma once
// Coulomb's law of one contact, regularised, and linearised for a Newton step that knows statuses.

#include "problems/algebra/friction_cone.hpp"

namespace ballast {

/// dr = source - gain du: what the linearised law makes of a change of the contact's velocity.
struct RegularStep {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  ContactStatus status = ContactStatus::open;
};

/// The law at the impulse `r`, where `u` is
///
///   u~ = u + epsilon_c (r - centre),   epsilon_c = epsilon / rho
///
/// Near the centre it is a law with compliance epsilon_c, and solvable whatever W's rank; where r
/// is the centre it is the law itself. The status comes from z = r - rho u~, rho = 1 /
/// lambda_max(W_cc) being the contact's natural scale: with 1 / epsilon_c in its place hundreds of
/// contacts would change at once. Alart, Curnier 1991, with the disc mu r_N for the tangential
/// impulse. epsilon > 0, and rho > 0. A contact of one row is one without friction.
RegularStep regular_step(double mu, double rho, double epsilon, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u);

}  // namespace ballast
