#pragma once
// The problems of a comparison: files, folders, patterns and manufactured ones, each with what the
// figures want to know of it.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

/// What cost is drawn against.
struct CaseFacts {
  int contacts = 0, rows = 0;
  int dofs = 0;                  ///< unknowns of the dynamics form; 0 when only W is known
  double rank_deficiency = 0.0;  ///< 1 - rank(W)/rows. By eigenvalues up to 1000 rows; above, from
                                 ///< the unknowns (a lower bound), and NaN where only W is known
  double mass_ratio = 1.0;  ///< largest over smallest mass of the bodies in contact; where only W
                            ///< is known, of lambda_max(W_cc)
  double velocity_scale =
      1.0;  ///< errors are relative to it [m/s]: rms of q over rows; g h for captured problems
  std::string content;  ///< key of the problem, its start and its scale
};

struct LoadedCase {
  FrictionProblem problem;
  Impulses warm_start;  ///< empty: the case has none
  CaseFacts facts;
  Impulses exact;  ///< a solution at 1e-9, where one was looked for and found; as loaded: what a
                   ///< file's reference holds (reference_of), which may be no solution
  /// Where a contact is, for who looks for the worst one: "contact 12", with bodies and gap where
  /// they are known.
  std::function<std::string(int)> describe_contact;
};

struct CompareCase {
  std::string name;  ///< unique in a comparison: a file's name, or the words that make the problem
  std::string family;  ///< cases of one kind: the file's name up to its numbers, the run and phase
                       ///< of a captured one
  /// Throws what is wrong with it: Error, InvalidProblem, std::bad_alloc.
  std::function<LoadedCase()> load;
  std::string word = {};    ///< of `ballast compare`, for this case; for one of stress:all, that
  bool has_bodies = false;  ///< captured: `ballast view` shows it in 3D
};

/// Each word is one of
///   a file (.hdf5, .h5, .dat), a folder (all such files in and below it), a pattern with * ? [ ]
///   known:..., pile:..., stress:...: problems made on the spot (ballast compare --help lists the
///   settings)
/// Files come sorted; equal names get their place in the list after them: "a.dat (2)". A file that
/// is missing or broken is a case, whose load() throws. Throws Error for words that name nothing: a
/// pattern without matches, a folder without problems, another kind of file, an unknown setting.
std::vector<CompareCase> compare_cases(const std::vector<std::string>& words);

/// Measures a problem. Errors are relative to `velocity_scale` [m/s], or to the rms of q when that
/// is 0. Throws InvalidProblem.
LoadedCase load_case(FrictionProblem problem, double velocity_scale = 0.0,
                     Impulses warm_start = {});

/// CaseFacts::content: all bits of the problem, its start and its scale.
std::string content_of(const FrictionProblem& problem, const Impulses& start, double scale);

/// Where the answer to a problem's file is kept from which distances are measured, an HDF5 file
/// with /solution/r: collection/problems/shaken/a.hdf5 -> collection/references/shaken/a.exact.
std::filesystem::path reference_of(const std::filesystem::path& problem_file);

/// "Capsules-i101-404.dat" -> "Capsules", "Rover1039.dat" -> "Rover".
std::string family_of_file(const std::string& file_name);

}  // namespace ballast
