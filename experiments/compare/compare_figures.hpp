#pragma once
// The figures of a comparison of backends.

#include <span>
#include <vector>

#include "experiments/compare/compare_table.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Performance and data profiles, cost against contacts, rank deficiency and mass ratio, of one
/// table. Empty when nobody solved anything.
std::vector<page::Picture> profile_figures(const CompareTable& table);
std::vector<page::Picture> cost_figures(const CompareTable& table);

/// Error against time on one case from one start: each backend's history to its tightest tolerance,
/// and where each tolerance was reached. Without panels when there is nothing to draw.
page::Picture work_precision_figure(std::span<const CompareRow> rows, const std::string& case_name,
                                    StartKind start);
/// The same over a family: geometric means over its cases.
page::Picture family_figure(std::span<const CompareRow> rows, const std::string& family,
                            StartKind start);

/// The k-th backend's line: eight colours, then the same dashed, then thin.
Curve backend_curve(size_t k, const std::string& title);

/// Adds the corners of a step curve, held up to `last`, to a curve.
Curve stairs(const StepCurve& steps, double last, Curve curve);

/// Height of a figure whose key has so many entries: the key grows, the axes stay [px].
int height_for(size_t entries);

/// Letters, digits, _ and -: what a figure's name may be of.
std::string figure_name(const std::string& text);

}  // namespace ballast
