#pragma once
// One attempt of a comparison in a process of its own, under limits of time and memory: what
// crashes, hangs or eats memory becomes a row.

#include "experiments/compare/compare_row.hpp"
#include "experiments/compare/drive_solver.hpp"

namespace ballast {

struct ChildLimits {
  double memory_MB = 4096.0;  ///< of address space, the program's own included; 0: none
  double warm_seconds =
      0.25;  ///< a solve that is shorter is repeated in the child for about so long, and the
             ///< fastest run counts: what is faster than a page fault is otherwise not measured
  int most_runs = 20;  ///< in one child
};

/// Solves the case with a solver made by `make` in a forked child, judges what comes back here, and
/// fills in what came of it in `row`; what was tried (row.measure, tolerance, start) must be in it.
/// `drive`'s measure, tolerance and scale are the row's. Throws InvalidProblem.
void solve_in_child(const MakeSolver& make, const LoadedCase& loaded, const DriveSettings& drive,
                    const ChildLimits& limits, CompareRow& row);

/// The same without a child, for a solver that has its work done in a program under limits of its
/// own (experiments/external).
void solve_outside(const MakeSolver& make, const LoadedCase& loaded, const DriveSettings& drive,
                   const ChildLimits& limits, CompareRow& row);

}  // namespace ballast
