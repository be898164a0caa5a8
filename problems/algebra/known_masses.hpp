#pragma once
// Masses that were looked at before: in a run every step brings the same.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// A copy of the bodies' masses and unknowns, to tell whether they are the same, bit by bit.
class KnownMasses {
 public:
  bool are_of(const DynamicsForm& dynamics) const;
  void keep(const DynamicsForm& dynamics);

 private:
  std::vector<int> dof_begin_, mass_begin_;
  std::vector<double> mass_;
};

/// FrictionProblem::validate() that looks at masses only if they are not `valid` already, and keeps
/// them there.
void validate(const FrictionProblem& problem, KnownMasses& valid);

}  // namespace ballast
