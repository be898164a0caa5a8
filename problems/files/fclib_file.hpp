#pragma once
// FCLIB's HDF5 layout (fclib 3.1): /fclib_local/{spacedim, W, vectors/{q, mu}},
// /fclib_global/{spacedim, M, H, vectors/{f, w, mu}}.

#include <filesystem>
#include <functional>
#include <variant>

#include "problems/files/stored_problem.hpp"

namespace ballast {

class Hdf5Arrays;

/// Throws ProblemFileError: not HDF5, a dataset that is missing, has the wrong size or holds NaN,
/// 2-D, bilateral parts.
std::variant<LocalProblem, GlobalProblem> read_fclib(const std::filesystem::path& file);

void write_fclib(const std::filesystem::path& file, const LocalProblem& local);
void write_fclib(const std::filesystem::path& file, const GlobalProblem& global);

/// Writes FCLIB HDF5, local when the problem has only the Delassus form, global otherwise; written
/// beside and renamed. One-row contacts become three rows with mu = 0 there (the format knows no
/// others). `add` writes what else shall be in the file, before it gets its name.
void write_problem(const std::filesystem::path& file, const FrictionProblem& problem,
                   const std::function<void(Hdf5Arrays&)>& add = nullptr);

}  // namespace ballast
