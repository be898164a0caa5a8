#pragma once
// Gauss-Seidel taken for a fixed point and accelerated by Anderson mixing (anderson.hpp). Safeguard
// in the spirit of Zhang, O'Donoghue, Boyd 2020: an extrapolation after which a sweep has more to
// do than before it is taken back.

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

struct AndersonPgsSettings {
  int memory = 8;
  double allowed_growth = 2.0;  ///< of a sweep's change, before the extrapolation is taken back
};

std::unique_ptr<Solver> make_anderson_pgs(const AndersonPgsSettings& settings = {});

}  // namespace ballast
