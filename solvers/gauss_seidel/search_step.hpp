#pragma once
// The step of a search that combines sweeps.

namespace ballast {

/// With x the iterate that the last sweep left and `before` the one that it began from: p := beta p
/// + gain (x - before), x += beta p (the old p), before := x.
struct SearchStep {
  double beta = 0.0, gain = 0.0;
};

}  // namespace ballast
