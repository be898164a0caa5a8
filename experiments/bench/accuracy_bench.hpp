#pragma once
// What an answer costs at which error. `ballast bench accuracy`: a simulated second, by solver and
// limit (the closed loop of `ballast compare --live`). `ballast bench captured`: problems that a
// run met (`ballast run --capture`), against every measure of how wrong it is: a comparison in
// fewer words.

#include <span>

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/live.hpp"

namespace ballast {

/// run_live, but the reference is the complete trajectory of the least mean error.
LiveComparison measure_accuracy(const LiveOptions& live,
                                const std::function<bool(const Trajectory&)>& said);

/// Of complete trajectories, a group to each: its cost, and all that live.csv holds.
std::vector<Measurement> accuracy_measurements(const LiveComparison& comparison);

/// Error over cost, a line to each solver.
Figure accuracy_figure(const LiveComparison& comparison);

/// A group to each solver, start and tolerance: how many are solved, and medians over problems: the
/// cost of those that are solved, errors and distances of all answers.
std::vector<Measurement> captured_measurements(std::span<const CompareRow> rows);

/// A panel to each measure over the cost, a curve to each solver and start; a point where half of
/// the problems are solved.
Figure captured_figure(std::span<const CompareRow> rows);

}  // namespace ballast
