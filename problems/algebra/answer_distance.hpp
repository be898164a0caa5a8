#pragma once
// How far an answer is from a solution that is known.

#include <limits>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// The distance of an answer from a solution. As constructed it means that no solution is known.
///
/// The judge's error says how well the law holds at each contact; it hides errors that many
/// contacts have in common: an answer at 1e-3 may carry forces that are tens of per cent away.
/// Impulses themselves are not compared: W is rank deficient, and no body feels a difference in its
/// null space. Coulomb's law may also have several solutions, in a jam above all: the distance is
/// from the given one.
struct AnswerDistance {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  /// Difference of the bodies' velocities, rms weighted by mass: sqrt(dv . M dv / sum of masses)
  /// [m/s]. A body's mass is the first entry of its block of M, which is that of a translation in
  /// all that Ballast makes. NaN where only W is known.
  double velocity = none;
  double contact_velocity = none;  ///< difference of u, rms over contacts [m/s]
  /// Difference of H^T r, the impulse of all contacts on the bodies, relative to the solution's, in
  /// the norm of M^-1: sqrt(dr . W dr / r . W r).
  double body_impulse = none;
  /// Relative difference of the force on the driven wall; NaN without such a wall.
  double wall_force = none;
  int statuses = -1;  ///< contacts whose status (open, stick, slip) is not the solution's
};

/// Returns the first body with one unknown, which a driven wall has; -1 if there is none or only W
/// is known.
int driven_wall(const FrictionProblem& problem);

/// Returns the distance, with velocities divided by `velocity_scale` [m/s]; AnswerDistance{} for an
/// empty `solution`. Throws InvalidProblem if one of the two has the wrong size.
AnswerDistance answer_distance(const FrictionProblem& problem, const Impulses& answer,
                               const Impulses& solution, double velocity_scale = 1.0);

}  // namespace ballast
