#pragma once
// Proofs that a friction problem has no solution, or none with impulses of a sensible size.
//
// Every solution has u_N >= 0 at every contact. Take any weights y_c >= 0 of the contacts, sum 1:
//
//   sum_c y_c u_N,c = q_N . y + r . (W^T y),   y standing on the normal rows
//
// so the mean of u_N with these weights is at most q_N . y + |r| |W^T y| whatever r is. Where
// q_N . y < 0, no impulses with |r| < -q_N . y / |W^T y| keep the contacts from sinking in. With
// W^T y = 0 none do. (Farkas' lemma for u_N >= 0. Friction isn't asked: a problem that only
// friction makes unsolvable isn't proved to be one.)

#include <string>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct NoSolution {
  /// Least |r| = sqrt(sum r_i^2) that any solution must have [N s]; infinity: there is none. 0:
  /// nothing was proved.
  double least_impulse = 0.0;
  /// The same over the largest |q_c| / lambda_max(W_cc), what one contact alone would need, and
  /// |M v_free| of a body, what would stop it, within the islands of the contacts with a weight:
  /// above beyond_sense a problem counts as one without solution.
  double least_growth = 0.0;
  /// -q_N . y: how fast some contact sinks in, whatever smaller impulses do [m/s].
  double approach = 0.0;
  int contacts = 0;       ///< with a weight above a thousandth of the largest
  int first_contact = 0;  ///< one of those with the largest weight

  /// Double precision knows u to 1e-16 of |W| |r|: with impulses this far beyond what is natural
  /// half of its digits say nothing.
  static constexpr double beyond_sense = 1e8;
  bool proved() const { return least_growth > beyond_sense; }
  /// One line; empty unless proved().
  std::string words() const;
};

/// Searches weights: contacts that no impulse moves, the normal impulses of `r` (those of a solver
/// that diverges tend to a proof), and what `sweeps` frictionless Gauss-Seidel sweeps add to them,
/// sweep after sweep, fewer where W has more than 600,000 entries or max_seconds are over. Where
/// only W is known, W^T y = 0 to rounding is asked. Returns the best proof found; builds W, unless
/// max_seconds are none. Throws InvalidProblem.
NoSolution look_for_no_solution(const FrictionProblem& problem, const Impulses& r, int sweeps = 500,
                                double max_seconds = 1e30);

}  // namespace ballast
