// Compiled in place of siconos.cpp where libsiconos-numerics is not used.

#include "solvers/backends/siconos.hpp"

namespace ballast {

bool has_siconos() { return false; }
std::unique_ptr<Solver> make_siconos(SiconosMethod) { return nullptr; }

}  // namespace ballast
