#pragma once
// Other ways to sweep than the plain one, for comparison: how one contact is solved, and
// relaxation. The plain sweep has its own fast loop and never comes here.

#include "solvers/parts/one_contact.hpp"

namespace ballast {

enum class LocalRule {
  exact,       ///< the contact's own solution (one_contact.hpp)
  projection,  ///< r_c := P_K(r_c - rho_c (u_c + mu |u_T| n)), rho_c = 1 / lambda_max(W_cc): one
               ///< step of De Saxce, Feng 1998
};

struct SweepVariant {
  LocalRule rule = LocalRule::exact;
  double relaxation = 1.0;  ///< in (0, 2): of each contact's change, projected back onto the cone

  bool plain() const { return rule == LocalRule::exact && relaxation == 1.0; }
};

/// One contact while all others are held. y = (r_N + c . r_T, r_T): in, the impulse; out, the next
/// one. u: in, the velocity (u_N, u_T - c u_N) that all impulses give. Both in the coordinates of
/// PrincipalContact. `lambda_max` of W_cc.
void resolve_by_variant(const SweepVariant& variant, const PrincipalContact& contact,
                        double lambda_max, const double* u, double* y, double& slip);

}  // namespace ballast
