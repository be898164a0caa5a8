#pragma once
// The comparison: cases x backends x tolerances x starts x repeats -> rows in a folder, resumable
// after any kind of death.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/compare/one_solve.hpp"

namespace ballast {

/// The best answer to a case that was found.
struct Reference {
  Impulses impulses;
  double error = 0.0;     ///< the judge's natural map, rms, over the case's velocity scale
  bool is_exact = false;  ///< it is a solution at 1e-9
  std::string solver;     ///< "start": no backend had a better one than the warm start, or zeros
};

/// Looks for a solution by newton_burst, then by `auto`, each in a child process from the warm
/// start, within `max_seconds` of wall clock together, about.
Reference find_reference(const LoadedCase& loaded, double max_seconds);

/// Sees to it that a solution of the case is known to measure distances from: LoadedCase::exact.
/// One that is there is judged; otherwise find_reference() looks for it (`max_seconds` = 0: nobody
/// does). What is found is kept in `folder` and judged anew where it is there already. Throws Error
/// where the folder cannot be written.
void find_exact(LoadedCase& loaded, double max_seconds, const std::filesystem::path& folder);

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
/// start, solver. Where a solver ran out of time to a looser tolerance it is not tried: the row is
/// a copy of that one, with a note. results.csv and manifest.json are written at the end and when
/// stopped. A case that cannot be loaded is one row (Verdict::unreadable, with the reason for its
/// note), which is tried again the next time; so is a row whose file is damaged.
std::vector<CompareRow> run_comparison(const std::vector<CompareCase>& cases,
                                       const CompareOptions& options,
                                       const CompareProgress& progress);

/// Key of the program that is running: its file's content.
std::string binary_key();

/// The BLAS and LAPACK libraries mapped into this process, by their file names:
/// "libopenblasp-r0.3.21.so"; "none" without.
std::string loaded_blas();

// The lists on the command lines of `ballast compare` and `ballast bench` -> settings. Everything
// wrong is a std::invalid_argument that says what was expected.

/// "pgs,nncg", "none", or "all": every backend that was built. Throws UnknownSolver, MissingSolver
/// for names.
std::vector<ComparedSolver> parse_solvers(const std::string& list);

/// Programs that solve (experiments/external). Throws std::invalid_argument: also for the name of a
/// backend.
std::vector<ComparedSolver> external_solvers(const std::vector<std::string>& words,
                                             const ExternalLimits& limits);

/// "1e-4,1e-8": numbers > 0, sorted from loose to tight, each once; or "none".
std::vector<double> parse_tolerances(const std::string& list);

/// "cold", "warm", "cold,warm".
std::vector<StartKind> parse_starts(const std::string& list);

}  // namespace ballast
