// Compiled in place of ipopt.cpp where Ipopt is not used.

#include "solvers/backends/ipopt.hpp"

namespace ballast {

bool has_ipopt() { return false; }
std::unique_ptr<Solver> make_ipopt() { return nullptr; }

}  // namespace ballast
