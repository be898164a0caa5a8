#pragma once
// Alternating directions with over-relaxation and adaptive penalty. Boyd et al. 2011; for contact:
// Acary, Bremond, Huber 2018 (ADMM in Siconos). One sparse factorisation serves all iterations with
// one penalty; the s-update (slip_shift.hpp) makes the law Coulomb's.

#include "solvers/seam/solver.hpp"

namespace ballast {

struct AdmmSettings {
  double relaxation = 1.6;
  double penalty = 0.1;  ///< the first one, in units of lambda_max(W_cc)
  int shift_every = 1;   ///< iterations between s-updates
  int adapt_every = 20;  ///< iterations between looks at the penalty; each look later by a fifth,
                         ///< so that it settles
  double adapt_from =
      3;  ///< a penalty is changed by no less than this factor: it costs a factorisation
};

std::unique_ptr<Solver> make_admm(const AdmmSettings& settings = {});

}  // namespace ballast
