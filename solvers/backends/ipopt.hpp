#pragma once
// The contact problem as a nonlinear program for Ipopt (Waechter, Biegler 2006). Each solve is a
// child process: Debian's Ipopt 3.11 with MUMPS does not survive a second one in the same process.

#include "solvers/seam/solver.hpp"

namespace ballast {

/// This build has the library. Where it has not, make_ipopt returns null.
bool has_ipopt();

/// The convex cone program with the s-update around it; polar coordinates (cone_program.hpp), exact
/// sparse Hessian. An iteration is one of Ipopt's own. (Tried
/// instead on 5 problems: mu r_N - |r_T|, mu^2 r_N^2 - |r_T|^2 and mu^2 r_N - |r_T|^2 / r_N: 50
/// iterations to 500 and no answer, where this takes 30.)
std::unique_ptr<Solver> make_ipopt();

}  // namespace ballast
