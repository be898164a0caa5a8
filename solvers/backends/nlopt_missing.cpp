// Compiled in place of nlopt.cpp where NLopt is not used.

#include "solvers/backends/nlopt.hpp"

namespace ballast {

bool has_nlopt() { return false; }
std::unique_ptr<Solver> make_nlopt(NloptMethod) { return nullptr; }

}  // namespace ballast
