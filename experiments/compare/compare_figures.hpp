#pragma once
// What the figures of the closed loop and of the bench share.

#include <string>
#include <utility>
#include <vector>

#include "experiments/page/plot.hpp"

namespace ballast {

/// The k-th backend's line: eight colours, then the same dashed, then thin.
Curve backend_curve(size_t k, const std::string& title);

/// Adds to a panel a line through `points` (x, y) in the style of `curve`, and a mark on each.
void add_marked_line(const std::vector<std::pair<double, double>>& points, Curve curve,
                     Panel& panel);

}  // namespace ballast
