#pragma once
// FCLIB's HDF5 layout (fclib 3.1): /fclib_local/{spacedim, W, vectors/{q, mu}},
// /fclib_global/{spacedim, M, H, vectors/{f, w, mu}}, and of answers:
//
//   /solution/{r, u}     impulses [N s] and relative velocities [m/s], three per contact
//   /solution/v          velocities of the bodies (dynamics form) [m/s, rad/s]
//   /ballast_answer/...  one number or text each: what was asked, and what the judge found

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "platform/hdf5_file.hpp"
#include "problems/files/stored_problem.hpp"

namespace ballast {

/// The global form where a file has both. Throws ProblemFileError: not HDF5, a dataset that is
/// missing, has the wrong size or holds NaN, 2-D, bilateral parts.
std::variant<LocalProblem, GlobalProblem> read_fclib(const std::filesystem::path& file);

/// What a written file has: bodies (M, H) where they are known and W where not, W (built where only
/// bodies are known), or W beside what is known of bodies.
enum class StoredForms { as_known, delassus, both };

/// The whole file or none: written beside and renamed. `add` adds what else shall be in it. One-row
/// contacts become three rows with mu = 0 (the format knows no others). Throws ProblemFileError;
/// InvalidProblem before anything is written.
void write_problem(const std::filesystem::path& file, const FrictionProblem& problem,
                   StoredForms forms = StoredForms::as_known,
                   const std::function<void(Hdf5Writer&)>& add = nullptr);

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

/// The values of a dataset, of which there must be so many. Throws Error.
template <typename Values>
Values sized(const Hdf5Reader& file, const std::string& dataset, Values values, std::size_t size) {
  if (values.size() != size)
    file.fail(dataset + " has " + std::to_string(values.size()) + " entries, must have " +
              std::to_string(size));
  return values;
}

}  // namespace ballast
