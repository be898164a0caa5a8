#pragma once

#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// The judge's scaled natural map of every contact [m/s]: what natural_map_rms is the root mean
/// square of. 0 where W_cc = 0; infinite where r or u is not finite. Throws InvalidProblem when r
/// has the wrong size.
std::vector<double> errors_by_contact(const FrictionProblem& problem, const Impulses& r);

}  // namespace ballast
