#pragma once
// Stored problems: FCLIB's HDF5 layout (local: W, q, mu; global: M, H, f, w, mu), read and written;
// Siconos' text format read.

#include <filesystem>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"
#include "problems/files/fclib_file.hpp"

namespace ballast {

/// Reads .hdf5/.h5 (FCLIB local or global, 3-D) or .dat (Siconos FrictionContact: dense, block or
/// sparse). Throws Error. Global problems keep the dynamics form when M is block diagonal by bodies
/// and a contact touches at most two of them; otherwise W is formed. A captured problem comes back
/// as it was written.
FrictionProblem read_problem(const std::filesystem::path& file);

/// Siconos' text format of FrictionContactProblem and GlobalFrictionContactProblem: numbers
/// separated by white space. Local: dimension, contacts, W, q, mu. Global: dimension, contacts, M,
/// H, q, b, mu: told apart by the rows of the first matrix and, in doubt, by the text behind it.
/// Matrices are dense, by blocks, or sparse. Not yet validated. Throws Error with the line;
/// InvalidProblem.
FrictionProblem read_siconos_text(const std::filesystem::path& file);

/// Returns whether the suffix is .hdf5, .h5 or .dat.
bool is_problem_file(const std::filesystem::path& file);

/// One problem file of a collection.
struct FoundProblem {
  std::filesystem::path file;
  std::filesystem::path name;  ///< path within the given folder, or the file's name
};

/// The problems that a word names: a file (that may be missing), a folder (all in and below it,
/// sorted), a pattern with * ? [ ]. Throws Error for a word that names none, and for other files.
std::vector<FoundProblem> find_problems(const std::string& word);

}  // namespace ballast
