// Compiled in place of siconos.cpp where libsiconos-numerics is not used.

#include "solvers/backends/siconos.hpp"

namespace ballast {

SolverMaker siconos_nsgs_maker() { return nullptr; }
SolverMaker siconos_prox_maker() { return nullptr; }
SolverMaker siconos_admm_maker() { return nullptr; }
SolverMaker siconos_nsn_ac_maker() { return nullptr; }

}  // namespace ballast
