// Compiled in place of nlopt.cpp where NLopt is not used.

#include "solvers/backends/nlopt.hpp"

namespace ballast {

SolverMaker nlopt_slsqp_maker() { return nullptr; }
SolverMaker nlopt_mma_maker() { return nullptr; }
SolverMaker nlopt_ccsaq_maker() { return nullptr; }

}  // namespace ballast
