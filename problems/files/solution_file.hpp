#pragma once
// An answer to a friction problem as a file of its own, in FCLIB's layout of solutions:
//
//   /solution/{r, u}     impulses [N s] and relative velocities [m/s], three per contact
//   /solution/v          velocities of the bodies (dynamics form) [m/s, rad/s]
//   /ballast_answer/...  one number or text each: what was asked, and what the judge found

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct StoredSolution {
  Impulses r;  ///< rows as in the problem
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::pair<std::string, std::string>> texts;
};

/// u and v are computed from r. Written whole or not at all. Throws ProblemFileError.
void write_solution(const std::filesystem::path& file, const FrictionProblem& problem,
                    const StoredSolution& solution);

/// The impulses of a file with /solution/r, whoever wrote it. Throws ProblemFileError: none there,
/// of another number of contacts, not finite.
Impulses read_solution(const std::filesystem::path& file, const FrictionProblem& problem);

}  // namespace ballast
