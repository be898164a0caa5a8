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
/// the judge agrees, or nothing comes of it any more. An iteration is one of Siconos' own. Null
/// where the library is not used.
SolverMaker
siconos_nsgs_maker();  ///< nonsmooth Gauss-Seidel, local Newton with line search and projections
SolverMaker siconos_prox_maker();    ///< proximal point around a nonsmooth Newton
SolverMaker siconos_admm_maker();    ///< ADMM, penalty by residual balancing
SolverMaker siconos_nsn_ac_maker();  ///< nonsmooth Newton on Alart-Curnier's function

}  // namespace ballast
