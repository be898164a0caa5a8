#pragma once
// Adapter to Siconos' numerics library
// (https://nonsmooth.gricad-pages.univ-grenoble-alpes.fr/siconos): the field's reference, solvers
// of its FrictionContactProblem  u = W r + q, mu. Its own formulas are in Acary, Bremond, Huber
// 2018, "On solving contact problems with Coulomb friction: formulations and numerical
// comparisons".

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Siconos cannot be interrupted, and ends the process on some errors: each call runs in a child
/// process, unless this process is itself a child that may be lost (a comparison's). The clock runs
/// in the library's own driver; processes, W in the library's form and the judge are start-up.
///
/// Where the budget asks for Siconos' own measure its tolerance is what was asked. Otherwise, and
/// where the judge does not agree, its tolerance, which is relative and in mixed units, is
/// tightened in rounds until the judge does, or nothing comes of it any more. An iteration is one
/// of Siconos' own.
enum class SiconosMethod {
  nsgs,       ///< nonsmooth Gauss-Seidel, local Newton with line search and projections
  nsgs_full,  ///< the same; its true error after every sweep, in place of what the sweep moved
  prox,       ///< proximal point around a nonsmooth Newton
  admm,       ///< ADMM, penalty by residual balancing
  nsn_ac      ///< nonsmooth Newton on Alart-Curnier's function
};
std::unique_ptr<Solver> make_siconos(SiconosMethod method);

/// This build has the library. Where it has not, make_siconos returns null.
bool has_siconos();

}  // namespace ballast
