#pragma once
// `ballast bench captured`: what an answer costs, against every measure of how wrong it is, on
// problems that a run met (`ballast run --capture`).

#include <functional>

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/comparison.hpp"
#include "experiments/page/plot.hpp"
#include "problems/algebra/contact_error.hpp"

namespace ballast {

struct CapturedOptions {
  std::vector<ComparedSolver> solvers;
  std::vector<double> tolerances;  ///< natural map rms over g h, from loose to tight
  std::vector<StartKind> starts{StartKind::warm};
  /// Processor seconds of one solve that a table of "solved within" counts.
  std::vector<double> within;
  double max_seconds = 5.0;     ///< of one solve
  double exact_seconds = 60.0;  ///< for a solution at 1e-9; 0: none is looked for
  int threads = 1;
  std::filesystem::path folder;  ///< exact/: solutions, kept
};

/// One solve.
struct CapturedRow {
  std::string problem, phase, solver;
  StartKind start = StartKind::warm;
  double tolerance = 0.0;  ///< [g h]
  bool solved = false;
  int contacts = 0, iterations = 0;
  double seconds = 0.0;     ///< of the processor: prepare and solve
  double error = 0.0;       ///< the judge's natural map rms [g h]
  AnswerDistance distance;  ///< velocities [g h]
  double k_art = 0.0;       ///< jam_stiffness.hpp [N/m]; NaN where the wall is not jammed
};

/// Every solver on every problem from every start to every tolerance. Once a tolerance is missed
/// the tighter ones are missed too, and not tried. `said` hears of each row; returning false stops.
/// Throws what a case's load() throws; Error.
std::vector<CapturedRow> measure_captured(const std::vector<CompareCase>& cases,
                                          const CapturedOptions& options,
                                          const std::function<bool(const CapturedRow&)>& said);

/// Medians over problems: cost of those that are solved, distances of all answers.
std::vector<Measurement> captured_measurements(const CapturedOptions& options,
                                               const std::vector<CapturedRow>& rows);

/// One line per solve.
std::string captured_csv(const std::vector<CapturedRow>& rows);

/// A panel to each measure over the cost, a curve to each solver and start; a point where half of
/// the problems are solved.
Figure captured_figure(const CapturedOptions& options, const std::vector<CapturedRow>& rows);

}  // namespace ballast
