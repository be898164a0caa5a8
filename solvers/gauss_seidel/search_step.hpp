#pragma once
// The step of a search that combines sweeps.

namespace ballast {

/// With x the iterate that the last sweep left, `before` the one that it began from and d = x -
/// before: the iterate moves by m = beta p + ahead d. Then p := m + gain d, x += m, before := x.
struct SearchStep {
  double beta = 0.0, gain = 0.0, ahead = 0.0;
};

}  // namespace ballast
