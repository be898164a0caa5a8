#pragma once
// The problems of a comparison, stored or made, with the facts that the figures need.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// The properties of a case that cost is drawn against, and its key.
struct CaseFacts {
  int contacts = 0, rows = 0;
  int dofs = 0;                  ///< unknowns of the dynamics form; 0 when only W is known
  double rank_deficiency = 0.0;  ///< 1 - rank(W)/rows: from eigenvalues up to 1000 rows; above, a
                                 ///< lower bound from the unknowns, or NaN where only W is known
  double mass_ratio = 1.0;  ///< largest over smallest mass of the bodies in contact; where only W
                            ///< is known, largest over smallest lambda_max(W_cc)
  double velocity_scale = 1.0;  ///< of errors [m/s]: rms of q over rows; g h (captured, stress:)
  std::string content;          ///< key of the problem, its start and its scale
};

struct LoadedCase {
  FrictionProblem problem;
  Impulses warm_start;  ///< empty: the case has none
  CaseFacts facts;
  Impulses exact;  ///< a solution at 1e-9, where find_exact() found one; as loaded: the impulses in
                   ///< a file's reference (reference_of), which may be no solution
  /// Says where a contact is: "contact 12", with bodies and gap where they are known.
  std::function<std::string(int)> describe_contact;
};

struct CompareCase {
  std::string name;  ///< unique in a comparison: a file's name, or the words that make the problem
  std::string family;  ///< cases of one kind share it: the file's name up to its numbers, or the
                       ///< run and phase of a captured problem
  /// Throws Error, InvalidProblem or std::bad_alloc where the problem cannot be loaded.
  std::function<LoadedCase()> load;
  std::string word = {};    ///< of `ballast compare`: makes this case alone, or is stress:all
  bool has_bodies = false;  ///< a captured problem, which `ballast view` shows in 3D
};

/// Each word is one of
///   a file (.hdf5, .h5, .dat), a folder (all such files in and below it), a pattern with * ? [ ]
///   known:..., pile:..., stress:...: problems made on the spot (settings: ballast compare --help)
/// Files are sorted; repeated names are numbered: "a.dat (2)". A missing or broken file is a case
/// whose load() throws. Throws Error for words that name no problem: a pattern without matches, a
/// folder without problems, another kind of file, an unknown setting.
std::vector<CompareCase> compare_cases(const std::vector<std::string>& words);

/// Validates a problem and computes its facts. Errors are relative to `velocity_scale` [m/s], or to
/// the rms of q when that is 0. Throws InvalidProblem.
LoadedCase load_case(FrictionProblem problem, double velocity_scale = 0.0,
                     Impulses warm_start = {});

/// Returns the HDF5 file of a problem's reference, from whose /solution/r distances are measured:
/// collection/problems/shaken/a.hdf5 -> collection/references/shaken/a.exact.
std::filesystem::path reference_of(const std::filesystem::path& problem_file);

/// "Capsules-i101-404.dat" -> "Capsules", "Rover1039.dat" -> "Rover".
std::string family_of_file(const std::string& file_name);

}  // namespace ballast
