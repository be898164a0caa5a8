#pragma once
// One attempt in a process of its own, under limits of time and memory: a solver that crashes,
// hangs or takes too much memory becomes a row.

#include <string>

#include "experiments/compare/compare_row.hpp"
#include "experiments/external/external_program.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {

struct SolveLimits {
  int max_iterations = 1 << 30;
  double memory_MB = 4096.0;  ///< limit of address space, the program's own included; 0: none
  /// A shorter solve is repeated in the child for about this time, and the fastest run counts: a
  /// solve faster than a page fault is otherwise not measured.
  double min_timing_seconds = 0.25;
  int most_runs = 20;  ///< in one child
};

/// A backend of a comparison: one of solver_list(), a test's own, or an external program.
struct ComparedSolver {
  std::string name;
  ContactLaw law = ContactLaw::coulomb;
  MakeSolver make;
  /// Of an external program, for which no child is forked: it has limits of its own. Else empty.
  std::string external_key = {};
};

/// Solves the case in a forked child, judges the answer in this process, and fills in the outcome
/// in `row`, which must hold the attempt (measure, tolerance, start and max_seconds). A backend
/// stops on the row's measure (Budget::fclib). Throws InvalidProblem.
void solve_case(const ComparedSolver& solver, const LoadedCase& loaded, const SolveLimits& limits,
                CompareRow& row);

}  // namespace ballast
