#pragma once
// Cases x backends x tolerances x starts x repeats -> rows in a folder; resumes after any kill.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "experiments/compare/one_solve.hpp"

namespace ballast {

/// The best answer found for a case.
struct Reference {
  Impulses impulses;
  double error = 0.0;     ///< the judge's natural map, rms, over the case's velocity scale
  bool is_exact = false;  ///< it is a solution at 1e-9
  std::string solver;     ///< "start": no backend had a better answer than the warm start or zeros
};

/// Looks for a solution with newton_burst, then with `auto`, each in a child process from the warm
/// start. Together they take about `max_seconds` of wall clock.
Reference find_reference(const LoadedCase& loaded, double max_seconds);

/// Fills LoadedCase::exact with a solution, from which distances are measured, or empties it. A
/// solution that is there is judged; otherwise find_reference() looks for one, unless `max_seconds`
/// is 0. A solution that is found is kept in `folder`, and judged again when it is read from there.
/// Throws Error where the folder cannot be written.
void find_exact(LoadedCase& loaded, double max_seconds, const std::filesystem::path& folder);

struct CompareOptions {
  std::vector<ComparedSolver> solvers;
  std::vector<double> tolerances{1e-4, 1e-8};
  std::vector<StartKind> starts{StartKind::cold};  ///< warm only where a case has a warm start
  Measure measure = Measure::natural_map;
  int repeats = 1;  ///< interleaved: all attempts, then all again; unsolved ones are not repeated
  double max_seconds = 60.0;  ///< of one solve, prepare included
  /// Time to find a solution of each case, from which distances are measured; 0: no search.
  double exact_seconds = 0.0;
  SolveLimits limits;
  std::filesystem::path folder;  ///< rows/<key>.json, results.csv, manifest.json
  std::string command;           ///< the command line, for the manifest
};

/// Called after each attempt, stored rows included: `done` of `count`.
using CompareProgress =
    std::function<void(const CompareRow& row, bool was_stored, size_t done, size_t count)>;

/// Tries every combination without a row, and returns the rows in order: repeat, case, tolerance,
/// start, solver. Where a solver ran out of time to a looser tolerance, a tighter one is not tried:
/// its row is a copy with a note. An interrupt (InterruptGuard) stops it; the rows so far stay.
/// results.csv and manifest.json are written at the end and when stopped. A case that cannot be
/// loaded is one row (Verdict::unreadable, with the reason as its note), which is tried again the
/// next time; so is a row whose file is damaged.
std::vector<CompareRow> run_comparison(const std::vector<CompareCase>& cases,
                                       const CompareOptions& options,
                                       const CompareProgress& progress);

/// Returns the key of the running program, made from the content of its file.
std::string binary_key();

/// Returns the BLAS and LAPACK libraries mapped into this process, by their file names:
/// "libopenblasp-r0.3.21.so"; "none" without.
std::string loaded_blas();

// The lists on the command lines of `ballast compare` and `ballast solve` -> settings. A wrong list
// throws std::invalid_argument, which says what was expected.

/// "pgs,nncg", "none", or "all": those that were built. Throws UnknownSolver, MissingSolver.
std::vector<ComparedSolver> parse_solvers(const std::string& list);

/// Solvers that are external programs (experiments/external). Throws std::invalid_argument, also
/// for the name of one of Ballast's backends.
std::vector<ComparedSolver> external_solvers(const std::vector<std::string>& words,
                                             const ExternalLimits& limits);

/// "1e-4,1e-8": numbers > 0, sorted from loose to tight, each once; or "none".
std::vector<double> parse_tolerances(const std::string& list);

/// "cold", "warm", "cold,warm".
std::vector<StartKind> parse_starts(const std::string& list);

}  // namespace ballast
