#pragma once
// Projected (nonsmooth) Gauss-Seidel: contact after contact, each solved exactly. Jean 1999;
// Siconos' NSGS.

#include <memory>

#include "solvers/gauss_seidel/sweep_variant.hpp"
#include "solvers/seam/solver.hpp"

namespace ballast {

struct GaussSeidelSettings {
  int first_check = 4;         ///< sweep of the first evaluation of the error
  double check_growth = 1.25;  ///< next evaluation after this factor more sweeps: the cost of
                               ///< checks stays below ~15 %
  SweepVariant variant{};      ///< plain: the fast loop
};

std::unique_ptr<Solver> make_gauss_seidel(const GaussSeidelSettings& settings = {});

}  // namespace ballast
