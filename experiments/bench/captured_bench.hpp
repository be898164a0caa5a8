#pragma once
// `ballast bench captured`: what an answer costs, against every measure of how wrong it is, on
// problems that a run met (`ballast run --capture`): a comparison in fewer words.

#include <span>

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/compare_row.hpp"

namespace ballast {

/// A group to each solver, start and tolerance: medians over problems, the cost of those that are
/// solved, errors and distances of all answers; and how many are solved `within` so many seconds.
std::vector<Measurement> captured_measurements(std::span<const CompareRow> rows,
                                               std::span<const double> within);

/// A panel to each measure over the cost, a curve to each solver and start; a point where half of
/// the problems are solved.
Figure captured_figure(std::span<const CompareRow> rows);

}  // namespace ballast
