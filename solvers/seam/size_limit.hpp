#pragma once
// How large a problem may be for a backend that keeps dense matrices.

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// What a backend promises: it takes every problem with at most so many contacts, and so many with
/// friction among them. Beyond that it may decline (UnsupportedProblem). Zeros: it takes problems
/// of any size.
struct SizeLimit {
  int contacts = 0;
  int with_friction = 0;  ///< contacts with mu > 0

  bool none() const { return contacts == 0; }
  bool admits(const FrictionProblem& problem) const;
};

/// Contacts with mu > 0.
int contacts_with_friction(const FrictionProblem& problem);

}  // namespace ballast
