// Stands in for the backends that factorise where SuiteSparse is not used.

#include "solvers/backends/admm.hpp"
#include "solvers/backends/auto.hpp"
#include "solvers/backends/interior_point.hpp"
#include "solvers/backends/newton.hpp"
#include "solvers/backends/sap.hpp"

namespace ballast {

SolverMaker admm_maker() { return nullptr; }
SolverMaker interior_point_maker() { return nullptr; }
SolverMaker auto_maker() { return nullptr; }
SolverMaker newton_ac_maker() { return nullptr; }
SolverMaker newton_nm_maker() { return nullptr; }
SolverMaker newton_fb_maker() { return nullptr; }
SolverMaker prox_newton_maker() { return nullptr; }
SolverMaker sap_maker() { return nullptr; }

}  // namespace ballast
