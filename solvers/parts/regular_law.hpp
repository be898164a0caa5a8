#pragma once
// Coulomb's law of one contact, regularised, and linearised for a Newton step that knows statuses:
//
//   u~ = u + epsilon_c (r - centre),   epsilon_c = epsilon lambda_max(W_cc)
//
// Near the centre it is a law with compliance epsilon_c, and solvable whatever W's rank; where r is
// the centre it is the law itself. The status comes from z = r - u~ / lambda_max, the contact's
// natural scale: with 1 / epsilon_c in its place hundreds of contacts would change at once. Alart,
// Curnier 1991, with the disc mu r_N for the tangential impulse.

#include <Eigen/Dense>

#include "solvers/parts/one_contact.hpp"

namespace ballast {

/// dr = source - gain du: what the linearised law makes of a change of the contact's velocity.
struct RegularStep {
  Eigen::Vector3d source = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gain = Eigen::Matrix3d::Zero();
  ContactStatus status = ContactStatus::open;
};

struct RegularContact {
  double friction = 0.0;
  double lambda_max = 0.0;  ///< of W_cc, > 0 [1/kg]
  double epsilon = 0.0;     ///< > 0, as a part of lambda_max
  bool half_line = false;   ///< no tangential impulse
};

/// `r`: the impulse; `u`: u~ there.
RegularStep regular_step(const RegularContact& contact, const Eigen::Vector3d& r,
                         const Eigen::Vector3d& u);

}  // namespace ballast
