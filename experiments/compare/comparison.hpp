#pragma once
// The comparison: cases x backends x tolerances x starts x repeats -> rows in a folder, resumable
// after any kind of death.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "experiments/compare/solve_child.hpp"

namespace ballast {

/// A backend of a comparison: of solver_list(), a test's own, or a program.
struct ComparedSolver {
  std::string name;
  ContactLaw law = ContactLaw::coulomb;
  MakeSolver make;
  /// Key of a program that is no part of this one; not empty: no child is forked for it.
  std::string external_key = {};
};

struct CompareOptions {
  std::vector<ComparedSolver> solvers;
  std::vector<double> tolerances{1e-4, 1e-8};
  std::vector<StartKind> starts{StartKind::cold};  ///< warm only where a case has a warm start
  Measure measure = Measure::natural_map;
  int repeats = 1;  ///< interleaved: every attempt once, then every attempt again; unsolved ones
                    ///< are not repeated
  double max_seconds = 60.0;  ///< of one solve, prepare included
  /// Spent on a solution of each case to measure distances from; 0: none is looked for.
  double exact_seconds = 0.0;
  SolveLimits limits;
  std::filesystem::path folder;  ///< rows/<key>.json, results.csv, manifest.json
  std::string command;           ///< for the manifest: how it was called
};

/// Called after each attempt, old rows included; `done` of `count`. Returning false stops the
/// comparison: what is there stays.
using CompareProgress =
    std::function<bool(const CompareRow& row, bool was_there, size_t done, size_t count)>;

/// Tries everything that has no row yet, and returns the rows in order: repeat, case, tolerance,
/// start, solver. results.csv and manifest.json are written at the end and when stopped. A case
/// that cannot be loaded is one row (Verdict::unreadable, with the reason for its note), which is
/// tried again the next time; so is a row whose file is damaged.
std::vector<CompareRow> run_comparison(const std::vector<CompareCase>& cases,
                                       const CompareOptions& options,
                                       const CompareProgress& progress);

/// Key of the program that is running: its file's content.
std::string binary_key();

/// The BLAS and LAPACK libraries mapped into this process, by their file names:
/// "libopenblasp-r0.3.21.so"; "none" without.
std::string loaded_blas();

}  // namespace ballast
