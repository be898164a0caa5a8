// Compiled in place of ipopt_*.cpp where Ipopt is not used.

#include "solvers/backends/ipopt.hpp"

namespace ballast {

bool has_ipopt() { return false; }
std::unique_ptr<Solver> make_ipopt() { return nullptr; }
std::unique_ptr<Solver> make_ipopt_mpcc() { return nullptr; }

}  // namespace ballast
