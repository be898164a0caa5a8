#pragma once
// FCLIB's HDF5 layout (fclib 3.1): /fclib_local/{spacedim, W, vectors/{q, mu}}, /fclib_global/{spacedim, M, H,
// vectors/{f, w, mu}}.

#include <filesystem>
#include <variant>

#include "problems/files/stored_problem.hpp"

namespace ballast {

/// Throws ProblemFileError: not HDF5, a dataset that is missing, has the wrong size or holds NaN, 2-D, bilateral parts.
std::variant<LocalProblem, GlobalProblem> read_fclib(const std::filesystem::path& file);

void write_fclib(const std::filesystem::path& file, const LocalProblem& local);
void write_fclib(const std::filesystem::path& file, const GlobalProblem& global);

}  // namespace ballast
