#pragma once
// The profiles of a comparison, and what its figures share with the closed loop's and the bench's.

#include <vector>

#include "experiments/compare/compare_table.hpp"
#include "experiments/page/page.hpp"

namespace ballast {

/// Performance profile, then data profile, of one table. Empty when
/// nobody solved anything.
std::vector<page::Picture> profile_figures(const CompareTable& table);

/// The k-th backend's line: eight colours, then the same dashed, then thin.
Curve backend_curve(size_t k, const std::string& title);

/// Adds to a panel a line through `points` (x, y) in the style of `curve`, and a mark on each.
void add_marked_line(const std::vector<std::pair<double, double>>& points, Curve curve,
                     Panel& panel);

/// Height of a figure whose key has so many entries: the key grows, the axes stay [px].
int height_for(size_t entries);

/// Letters, digits, _ and -: what a figure's name may be of.
std::string figure_name(const std::string& text);

}  // namespace ballast
