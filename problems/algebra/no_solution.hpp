#pragma once
// Proofs that a friction problem has no solution, or none with impulses of a sensible size.
//
// Every solution has u_N >= 0 at every contact. Take any weights y_c >= 0 of the contacts, sum 1:
//
//   sum_c y_c u_N,c = q_N . y + r . (W^T y),   y placed on the normal rows
//
// so the mean of u_N with these weights is at most q_N . y + |r| |W^T y| whatever r is. Where
// q_N . y < 0, no impulses with |r| < -q_N . y / |W^T y| keep the contacts from sinking in. With
// W^T y = 0 none do. (Farkas' lemma for u_N >= 0. Friction is ignored: a problem that only friction
// makes unsolvable is not recognised.)

#include <string>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct NoSolutionProof {
  /// Lower bound on |r| = sqrt(sum r_i^2) of any solution [N s]; infinity: there is none. 0:
  /// nothing was proved.
  double least_impulse = 0.0;
  /// The same over the largest |q_c| / lambda_max(W_cc), the impulse that one contact alone would
  /// need, and |M v_free| of a body, which would stop it, in the islands of the contacts with a
  /// weight. Above beyond_sense a problem counts as one without solution.
  double least_growth = 0.0;
  /// -q_N . y [m/s]: the weighted mean of the speeds at which contacts sink in without impulses.
  double approach = 0.0;
  int contacts = 0;       ///< number with a weight above a thousandth of the largest
  int first_contact = 0;  ///< one of those with the largest weight

  /// Double precision resolves u to 1e-16 of |W| |r|: with impulses this far beyond the natural
  /// size half of its digits are meaningless.
  static constexpr double beyond_sense = 1e8;
  bool proved() const { return least_growth > beyond_sense; }
  /// One line; empty unless proved().
  std::string words() const;
};

/// Tries weights: single contacts that no normal impulse moves, the normal impulses of `r` (those
/// of a diverging solver tend to a proof), and the increment of each of `sweeps` frictionless
/// Gauss-Seidel sweeps, fewer where W has more than 600,000 entries or max_seconds are over. Where
/// only W is known, W^T y must be 0 to rounding. Returns the best proof found. Builds W, unless
/// max_seconds is 0. Throws InvalidProblem.
NoSolutionProof prove_no_solution(const FrictionProblem& problem, const Impulses& r,
                                  int sweeps = 500, double max_seconds = 1e30);

}  // namespace ballast
