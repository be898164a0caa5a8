#include "solvers/seam/solver.hpp"

#include "solvers/seam/fclib_stop.hpp"

namespace ballast {

const char* name_of(StopReason reason) {
  switch (reason) {
    case StopReason::reached_tolerance:
      return "reached_tolerance";
    case StopReason::iteration_limit:
      return "iteration_limit";
    case StopReason::time_limit:
      return "time_limit";
    case StopReason::stalled:
      return "stalled";
    case StopReason::numerical_failure:
      return "numerical_failure";
  }
  return "unknown";
}

const char* name_of(ContactLaw law) {
  switch (law) {
    case ContactLaw::coulomb:
      return "coulomb";
    case ContactLaw::convex_relaxation:
      return "convex_relaxation";
    case ContactLaw::pyramid:
      return "pyramid";
  }
  return "unknown";
}

double Budget::aim() const { return fclib ? fclib->aim() : tolerance; }

}  // namespace ballast
