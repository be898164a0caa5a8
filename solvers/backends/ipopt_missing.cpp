// Compiled in place of ipopt_*.cpp where Ipopt is not used.

#include "solvers/backends/ipopt.hpp"

namespace ballast {

SolverMaker ipopt_maker() { return nullptr; }
SolverMaker ipopt_mpcc_maker() { return nullptr; }

}  // namespace ballast
