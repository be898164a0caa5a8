// Replaces the makers of backends whose libraries CMake has not found.

#include "solvers/backends/backends.hpp"

namespace ballast {

#ifdef BALLAST_WITHOUT_IPOPT
std::unique_ptr<Solver> make_ipopt() { return nullptr; }
#endif
#ifdef BALLAST_WITHOUT_NLOPT
std::unique_ptr<Solver> make_nlopt() { return nullptr; }
#endif
#ifdef BALLAST_WITHOUT_SICONOS
std::unique_ptr<Solver> make_siconos(SiconosMethod) { return nullptr; }
#endif

}  // namespace ballast
