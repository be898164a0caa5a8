#pragma once
// How far an answer is from a solution that is known.

#include <limits>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// How far an answer is from a solution; as made: no solution is known.
///
/// The judge's error says how well the law holds, contact by contact; it hides what is wrong over
/// many contacts together: an answer at 1e-3 may carry forces that are tens of per cent away.
/// Impulses themselves are not compared: W is rank deficient, and what lies in its null space no
/// body feels. Coulomb's law may also have several solutions, in a jam above all: the distance is
/// from the one that is given.
struct AnswerDistance {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  /// Of the bodies' velocities, rms weighted by mass: sqrt(dv . M dv / sum of masses) [m/s], the
  /// mass of a body being M's first entry (in all that Ballast makes a translation). NaN where only
  /// W is known.
  double velocity = none;
  double contact_velocity = none;  ///< of u, rms over contacts [m/s]
  /// Of H^T r, what the contacts together give to the bodies, as a part of the solution's: in the
  /// norm of M^-1, which is sqrt(dr . W dr / r . W r).
  double body_impulse = none;
  /// Of the force on the driven wall, as a part of the solution's; NaN without such a wall.
  double wall_force = none;
  int statuses = -1;  ///< contacts whose status (open, stick, slip) is not the solution's
};

/// The first body with one unknown, as a wall that a force drives has; -1 without, and where only W
/// is known.
int driven_wall(const FrictionProblem& problem);

/// Velocities over `velocity_scale` [m/s]. An empty `solution`: AnswerDistance{}. Throws
/// InvalidProblem where one of the two has the wrong size.
AnswerDistance answer_distance(const FrictionProblem& problem, const Impulses& answer,
                               const Impulses& solution, double velocity_scale = 1.0);

}  // namespace ballast
