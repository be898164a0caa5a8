#pragma once
// Adapter to Siconos' numerics library
// (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos): the field's reference, solvers
// of its FrictionContactProblem  u = W r + q, mu. Its own formulas are in Acary, Bremond, Huber
// 2018, "On solving contact problems with Coulomb friction: formulations and numerical
// comparisons".

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Each solve runs in child processes (Siconos cannot be interrupted, and ends the process on some
/// errors), in rounds: Siconos' tolerance, which is relative and in mixed units, is tightened until
/// the judge agrees, or nothing comes of it any more. An iteration is one of Siconos' own.
enum class SiconosMethod {
  nsgs,   ///< nonsmooth Gauss-Seidel, local Newton with line search and projections
  prox,   ///< proximal point around a nonsmooth Newton
  admm,   ///< ADMM, penalty by residual balancing
  nsn_ac  ///< nonsmooth Newton on Alart-Curnier's function
};
std::unique_ptr<Solver> make_siconos(SiconosMethod method);

/// This build has the library. Where it has not, make_siconos returns null.
bool has_siconos();

}  // namespace ballast
