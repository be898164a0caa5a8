#pragma once
// A method of sweeps that takes a problem in either form: over bodies, or over a stored W.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// The same iteration, written once for what sweeps over bodies and for what sweeps over a stored
/// W. A problem that has both forms is swept over its bodies.
template <typename OverBodies, typename OverMatrix>
struct EitherForm {
  OverBodies bodies;
  OverMatrix matrix;

  /// visit(bodies) or visit(matrix): the one that takes the problem.
  template <typename Visit>
  auto visit(const FrictionProblem& problem, Visit&& visit) {
    return problem.has_dynamics ? visit(bodies) : visit(matrix);
  }
};

}  // namespace ballast
