#pragma once
// Problems manufactured so that an exact solution is known: choose r and u that obey Coulomb's law,
// then q = u - W r.

#include <cstdint>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct KnownSolutionSettings {
  int bodies = 20;
  int contacts = 40;  ///< more than twice the bodies: W is rank deficient
  double friction_min = 0.0, friction_max = 1.0;
  double mass_ratio = 1.0;             ///< masses log-uniform in [1, mass_ratio] kg
  double open_fraction = 0.25;         ///< contacts with r = 0, u_N > 0
  double slip_fraction = 0.35;         ///< r on the cone's side, u_T opposite; the rest stick
  double frictionless_fraction = 0.1;  ///< one-row contacts
  int copies = 1;  ///< of each contact, sharing its impulse: W grows, its rank stays
  /// Masses are multiplied by mass_unit, velocities by velocity_unit, impulses by both: the same
  /// motion in other units.
  double mass_unit = 1.0, velocity_unit = 1.0;
  std::uint64_t seed = 1;
};

struct KnownSolution {
  FrictionProblem problem;  ///< dynamics form
  Impulses r;         ///< one exact solution (the impulses need not be unique when W is singular)
  Eigen::VectorXd u;  ///< its relative velocities
};

KnownSolution make_known_solution(const KnownSolutionSettings& settings);

/// Repeats every contact `copies` times, its copies in a row (dynamics form only). Velocities do
/// not change; impulses are no longer unique.
void repeat_contacts(FrictionProblem& problem, int copies);

/// Rows n, t1, t2 of a right-handed frame: n is a unit vector, t1 is perpendicular to n and to
/// `other`, which must not be parallel to n.
inline Eigen::Matrix3d contact_frame(const Eigen::Vector3d& n, const Eigen::Vector3d& other) {
  const Eigen::Vector3d t1 = n.cross(other).normalized();
  Eigen::Matrix3d frame;
  frame << n.transpose(), t1.transpose(), n.cross(t1).transpose();
  return frame;
}

/// The block of H of a rigid body: the rows n, t1, t2 of `frame` times the velocity v + omega x arm
/// at a point.
inline Eigen::MatrixXd rigid_rows(const Eigen::Matrix3d& frame, const Eigen::Vector3d& arm) {
  Eigen::Matrix3d cross;  // cross omega = arm x omega
  cross << 0, -arm[2], arm[1], arm[2], 0, -arm[0], -arm[1], arm[0], 0;
  Eigen::MatrixXd rows(3, 6);
  rows << frame, -frame * cross;
  return rows;
}

}  // namespace ballast
