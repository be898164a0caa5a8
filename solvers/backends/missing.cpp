// In place of the backends whose libraries CMake has not found.

#include "solvers/backends/backends.hpp"

namespace ballast {

#ifdef BALLAST_WITHOUT_IPOPT
bool has_ipopt() { return false; }
std::unique_ptr<Solver> make_ipopt() { return nullptr; }
#endif
#ifdef BALLAST_WITHOUT_NLOPT
bool has_nlopt() { return false; }
std::unique_ptr<Solver> make_nlopt() { return nullptr; }
#endif
#ifdef BALLAST_WITHOUT_SICONOS
bool has_siconos() { return false; }
std::unique_ptr<Solver> make_siconos(SiconosMethod) { return nullptr; }
#endif

}  // namespace ballast
