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
  double mass_ratio = 1.0;      ///< masses log-uniform in [1, mass_ratio] kg
  double open_fraction = 0.25;  ///< contacts with r = 0, u_N > 0
  double slip_fraction =
      0.35;  ///< contacts with r on the cone's side, u_T opposite; the rest stick
  double frictionless_fraction = 0.1;  ///< one-row contacts
  int copies =
      1;  ///< each contact so many times, its impulse shared: W's rank stays, its size grows
  double mass_unit = 1.0;  ///< masses are multiplied by it,
  double velocity_unit =
      1.0;  ///< velocities by this, impulses by both: the same motion in other units
  std::uint64_t seed = 1;
};

struct KnownSolution {
  FrictionProblem problem;  ///< dynamics form
  Impulses r;         ///< one exact solution (the impulses need not be unique when W is singular)
  Eigen::VectorXd u;  ///< its relative velocities
};

KnownSolution make_known_solution(const KnownSolutionSettings& settings);

/// Every contact `copies` times, one copy after the other (dynamics form only). Velocities do not
/// change; impulses are no longer unique.
void repeat_contacts(FrictionProblem& problem, int copies);

/// The same motion in other units (dynamics form only): M times `mass`, v_free and bias times
/// `velocity`. Angular unknowns are taken as velocities at a distance of one length unit, so that H
/// stays.
void change_units(FrictionProblem& problem, double mass, double velocity);

}  // namespace ballast
