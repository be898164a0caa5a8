#include "solvers/seam/size_limit.hpp"

#include <algorithm>

namespace ballast {

int contacts_with_friction(const FrictionProblem& problem) {
  return static_cast<int>(std::count_if(problem.friction.begin(), problem.friction.end(),
                                        [](double mu) { return mu > 0.0; }));
}

bool SizeLimit::admits(const FrictionProblem& problem) const {
  return none() ||
         (problem.contact_count() <= contacts && contacts_with_friction(problem) <= with_friction);
}

}  // namespace ballast
