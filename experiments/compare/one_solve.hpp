#pragma once
// One attempt, in a process of its own, under limits of time and memory: what crashes, hangs or
// eats memory becomes a row. It goes to a tolerance in either measure, timed outside the judge,
// with its history.

#include <functional>
#include <memory>
#include <string>

#include "experiments/compare/compare_row.hpp"
#include "experiments/external/external_program.hpp"
#include "solvers/seam/run_solver.hpp"

namespace ballast {

/// Makes a backend of solver_list(), a test's own, or one that starts a program.
using MakeSolver = std::function<std::unique_ptr<Solver>()>;

struct SolveLimits {
  int max_iterations = 1 << 30;
  double memory_MB = 4096.0;  ///< of address space, the program's own included; 0: none
  double warm_seconds =
      0.25;  ///< a solve that is shorter is repeated in the child for about so long, and the
             ///< fastest run counts: what is faster than a page fault is otherwise not measured
  int most_runs = 20;  ///< in one child
};

/// A backend of a comparison: of solver_list(), a test's own, or a program.
struct ComparedSolver {
  std::string name;
  ContactLaw law = ContactLaw::coulomb;
  MakeSolver make;
  /// Key of a program that is no part of this one; not empty: no child is forked for it, as the
  /// program is under limits of its own (experiments/external).
  std::string external_key = {};
};

/// Solves the case in a forked child, judges what comes back here, and fills in what came of it in
/// `row`; what was tried (its measure, tolerance, start and max_seconds) must be in it. A backend
/// stops on the measure that is asked for: it looks at it wherever it evaluates its error
/// (Budget::fclib). Throws InvalidProblem.
void solve_case(const ComparedSolver& solver, const LoadedCase& loaded, const SolveLimits& limits,
                CompareRow& row);

}  // namespace ballast
