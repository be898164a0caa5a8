#pragma once
// FCLIB's HDF5 layout (fclib 3.1): /fclib_local/{spacedim, W, vectors/{q, mu}},
// /fclib_global/{spacedim, M, H, vectors/{f, w, mu}}.

#include <filesystem>
#include <functional>
#include <variant>

#include "problems/files/stored_problem.hpp"

namespace ballast {

class Hdf5Writer;

/// The global form where a file has both. Throws ProblemFileError: not HDF5, a dataset that is
/// missing, has the wrong size or holds NaN, 2-D, bilateral parts.
std::variant<LocalProblem, GlobalProblem> read_fclib(const std::filesystem::path& file);

/// The whole file or none: written beside and renamed. `add` adds what else shall be in it. Throws
/// ProblemFileError.
void write_fclib(const std::filesystem::path& file,
                 const std::variant<LocalProblem, GlobalProblem>& problem,
                 const std::function<void(Hdf5Writer&)>& add = nullptr);

/// The same for any problem: local when it has only the Delassus form, global otherwise. One-row
/// contacts become three rows with mu = 0 there (the format knows no others). Throws
/// ProblemFileError; InvalidProblem before anything is written.
void write_problem(const std::filesystem::path& file, const FrictionProblem& problem,
                   const std::function<void(Hdf5Writer&)>& add = nullptr);

/// The same with W beside M and H: builds W.
void write_problem_forms(const std::filesystem::path& file, const FrictionProblem& problem,
                         const std::function<void(Hdf5Writer&)>& add = nullptr);

}  // namespace ballast
