#include "solvers/seam/solver.hpp"

#include "platform/text.hpp"
#include "solvers/seam/fclib_stop.hpp"

namespace ballast {

const char* name_of(StopReason reason) {
  return name_in(
      {"reached_tolerance", "iteration_limit", "time_limit", "stalled", "numerical_failure"},
      reason);
}

const char* name_of(Verdict verdict) { return name_in(verdict_names, verdict); }

const char* name_of(ContactLaw law) {
  return name_in({"coulomb", "convex_relaxation", "pyramid"}, law);
}

double Budget::aim() const { return fclib ? fclib->aim() : tolerance; }

}  // namespace ballast
