#pragma once
// Stored problems: FCLIB's HDF5 layout (local: W, q, mu; global: M, H, f, w, mu), read and written; Siconos' text
// format read.

#include <filesystem>
#include <functional>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

class Hdf5Arrays;

/// What is wrong with a problem file; what() starts with the file's name and names the group, dataset and entry.
class ProblemFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Reads .hdf5/.h5 (FCLIB local or global, 3-D) or .dat (Siconos FrictionContact: dense, block or sparse). Throws
/// ProblemFileError. Global problems keep the dynamics form when M is block diagonal by bodies and a contact touches at
/// most two of them; otherwise W is formed. What a run captured comes back in the form in which it was written.
FrictionProblem read_problem(const std::filesystem::path& file);

/// Writes FCLIB HDF5, local when the problem has only the Delassus form, global otherwise; written beside and renamed.
/// One-row contacts become three rows with mu = 0 there (the format knows no others).
/// `add` writes what else shall be in the file, before it gets its name.
void write_problem(const std::filesystem::path& file, const FrictionProblem& problem,
                   const std::function<void(Hdf5Arrays&)>& add = nullptr);

}  // namespace ballast
