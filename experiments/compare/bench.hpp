#pragma once
// The bench: cases x backends x tolerances x starts x repeats -> rows in a folder, resumable after
// any kind of death.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "experiments/compare/bench_case.hpp"
#include "experiments/compare/bench_row.hpp"
#include "experiments/compare/solve_child.hpp"

namespace ballast {

/// A backend of a bench: of solver_list(), or a test's own.
struct BenchSolver {
  std::string name;
  ContactLaw law = ContactLaw::coulomb;
  SolverMaker make = nullptr;
};

struct BenchOptions {
  std::vector<BenchSolver> solvers;
  std::vector<double> tolerances{1e-4, 1e-8};
  std::vector<StartKind> starts{StartKind::cold};  ///< warm only where a case has a warm start
  Measure measure = Measure::natural_map;
  int repeats = 1;  ///< interleaved: every attempt once, then every attempt again; unsolved ones
                    ///< are not repeated
  double max_seconds = 60.0;  ///< of one solve, prepare included
  int max_iterations = 1 << 30;
  ChildLimits limits;
  std::filesystem::path folder;  ///< rows/<key>.json, results.csv, manifest.json
  std::string command;           ///< for the manifest: how it was called
};

/// Called after each attempt, old rows included; `done` of `count`. Returning false stops the
/// bench: what is there stays.
using BenchProgress =
    std::function<bool(const BenchRow& row, bool was_there, size_t done, size_t count)>;

/// Tries everything that has no row yet, and returns the rows in order: repeat, case, tolerance,
/// start, solver. results.csv and manifest.json are written at the end and when stopped. A case
/// that cannot be loaded throws ProblemFileError or InvalidProblem.
std::vector<BenchRow> run_bench(const std::vector<BenchCase>& cases, const BenchOptions& options,
                                const BenchProgress& progress);

/// Key of the program that is running: its file's content.
std::string binary_key();

/// The BLAS and LAPACK libraries mapped into this process, by their file names:
/// "libopenblasp-r0.3.21.so"; "none" without.
std::string loaded_blas();

}  // namespace ballast
