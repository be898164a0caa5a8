#pragma once
// Spectral projected gradient with a nonmonotone line search. Birgin, Martinez, Raydan 2000 (SPG2);
// in contact mechanics Heyn, Anitescu, Tasora, Negrut 2013, with diagonal scaling and the s-update
// (slip_shift.hpp).

#include <memory>

#include "solvers/seam/solver.hpp"

namespace ballast {

struct SpgSettings {
  int memory = 10;       ///< energies that a step may not exceed
  int shift_every = 10;  ///< iterations between s-updates
};

std::unique_ptr<Solver> make_spg(const SpgSettings& settings = {});

}  // namespace ballast
