#pragma once
// The convex cone program with the s-update, by NLopt's gradient-based optimisers for constraints
// (Johnson, NLopt): SLSQP (Kraft 1994) and MMA (Svanberg 2002).

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Contacts at the apex of their cone, as a projected gradient step tells, are left out of a round;
/// the others have |r_T| <= mu r_N. NLopt keeps the Jacobian dense, and SLSQP a dense factor of the
/// Hessian: larger problems are declined. An iteration is one evaluation of the objective.
enum class NloptMethod { slsqp, mma };
std::unique_ptr<Solver> make_nlopt(NloptMethod method);

/// This build has the library. Where it has not, make_nlopt returns null.
bool has_nlopt();

inline constexpr SizeLimit nlopt_slsqp_limit{.contacts = 60, .with_friction = 60};
inline constexpr SizeLimit nlopt_mma_limit{.contacts = 400, .with_friction = 12};

}  // namespace ballast
