#pragma once
// What came of a solve: the solver's word and the judge's together.

#include <string>

#include "problems/algebra/contact_error.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

enum class Verdict {
  solved,       ///< the solver says so and the judge agrees on every part of the law
  unsolved,     ///< stopped before: a limit, standing still, a failure
  denied,       ///< the solver says that it is solved, and the judge does not agree
  no_solution,  ///< no solution found: r grows without bound, or contacts that nothing can move
                ///< sink in
};

/// One word, for columns: "solved", "unsolved", "denied", "no_solution".
const char* name_of(Verdict verdict);

/// `growth` of a judged answer beyond which r is said to grow without bound.
constexpr double unbounded_growth = 1e8;

/// Of impulses with that error, which a solver returned for that reason under that tolerance [m/s].
Verdict verdict_of(StopReason reason, const ContactError& error, double tolerance);

/// The same where Siconos' measure (ContactError::fclib) is what was asked for: it alone decides,
/// but that it divides by |r|, and what grows without bound meets it: that is no solution.
Verdict fclib_verdict_of(StopReason reason, const ContactError& error, double tolerance);

/// In words, one line: "solved", "the judge denies it: -u_N is 0.3 m/s (rms), at most 4e-08 may
/// be", "no solution found; r grows without bound: ...".
std::string words_of(Verdict verdict, StopReason reason, const ContactError& error,
                     double tolerance);

/// A verdict with its words.
struct Finding {
  Verdict verdict = Verdict::unsolved;
  std::string words;
};

/// The verdict on impulses r that were judged as `error`; for what is not solved with a search for
/// a proof that there is no solution (look_for_no_solution: builds W, so never within a step).
Finding finding_on(const FrictionProblem& problem, const Impulses& r, StopReason reason,
                   const ContactError& error, double tolerance);

}  // namespace ballast
