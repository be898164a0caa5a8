#include "solvers/seam/verdict.hpp"

#include <sstream>

#include "problems/algebra/no_solution.hpp"

namespace ballast {
namespace {

/// The first part of the law that the answer misses.
std::string what_is_missed(const ContactError& error, double tolerance) {
  if (!error.finite) return "the impulses, or velocities that they give, are not finite";
  std::ostringstream text;
  text.precision(3);
  const auto missed = [&](const char* part, double value, double bound) {
    text << part << " is " << value << " m/s (rms), at most " << bound << " may be";
    return text.str();
  };
  const double bound = ContactError::bound_factor * tolerance;
  if (!(error.natural_map_rms <= tolerance))
    return missed("the natural map", error.natural_map_rms, tolerance);
  if (!(error.approach_rms <= bound)) return missed("-u_N", error.approach_rms, bound);
  if (!(error.cone_rms <= bound))
    return missed("the distance of r from its cones", error.cone_rms, bound);
  return missed("the complementarity of r and u", error.complementarity_rms, bound);
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::solved:
      return "solved";
    case Verdict::unsolved:
      return "unsolved";
    case Verdict::denied:
      return "denied";
    case Verdict::no_solution:
      return "no_solution";
  }
  return "unknown";
}

namespace {

/// `within`: the measure that was asked for is within the tolerance.
Verdict verdict_from(bool within, StopReason reason, const ContactError& error, double tolerance) {
  const bool claimed = reason == StopReason::reached_tolerance;
  if (within) return claimed ? Verdict::solved : Verdict::unsolved;
  // No impulse helps, or those that were tried have left every scale of the problem.
  const bool sinks = error.finite && error.immovable_approach > tolerance;
  const bool grows = error.finite && error.growth > unbounded_growth;
  if (sinks || grows) return Verdict::no_solution;
  return claimed ? Verdict::denied : Verdict::unsolved;
}

}  // namespace

Verdict verdict_of(StopReason reason, const ContactError& error, double tolerance) {
  return verdict_from(error.within(tolerance), reason, error, tolerance);
}

Verdict fclib_verdict_of(StopReason reason, const ContactError& error, double tolerance) {
  const bool within =
      error.finite && error.fclib <= tolerance && !(error.growth > unbounded_growth);
  // Its tolerance is a pure number; contacts that sink in are measured in m/s.
  return verdict_from(within, reason, error, tolerance * error.velocity_scale);
}

std::string words_of(Verdict verdict, StopReason reason, const ContactError& error,
                     double tolerance) {
  std::ostringstream text;
  text.precision(3);
  switch (verdict) {
    case Verdict::solved:
      return "solved";
    case Verdict::unsolved:
      return std::string("unsolved: ") + name_of(reason);
    case Verdict::denied:
      return "the judge denies it: " + what_is_missed(error, tolerance);
    case Verdict::no_solution:
      break;
  }
  text << "no solution found; ";
  if (error.immovable_approach > tolerance)
    text << "a contact that no impulse moves sinks in at " << error.immovable_approach << " m/s";
  else
    text << "r grows without bound: " << error.growth << " times what a contact alone needs";
  return text.str();
}

Finding finding_on(const FrictionProblem& problem, const Impulses& r, StopReason reason,
                   const ContactError& error, double tolerance) {
  Finding found;
  found.verdict = verdict_of(reason, error, tolerance);
  if (found.verdict != Verdict::solved) {
    const NoSolution proof = look_for_no_solution(problem, r);
    // Sinking in by less than what is tolerated is no reason.
    if (proof.proved() && proof.approach > tolerance) return {Verdict::no_solution, proof.words()};
  }
  found.words = words_of(found.verdict, reason, error, tolerance);
  return found;
}

}  // namespace ballast
