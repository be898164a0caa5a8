#pragma once
// What a run's user must be told without asking: steps that missed their tolerance, overlaps that
// can be seen, energy that no law of contact gives. And what to do about each.

#include <string>
#include <vector>

#include "experiments/measure/run_data.hpp"

namespace ballast {

struct RunTrust {
  long steps = 0, missed = 0;  ///< missed: the judge does not call them solved
  /// Rms natural map over the steps whose error is known, in error_unit.
  double error_mean = not_known, error_worst = not_known;
  double tolerance = not_known;        ///< in error_unit
  std::string error_unit;              ///< "g h", or "m/s" without gravity
  double deepest = not_known;          ///< overlap [m]
  double deepest_time = not_known;     ///< [s]
  double smallest_radius = not_known;  ///< circumradius of the smallest body [m]
  double gained = not_known;           ///< sum of energy_gained [J]
  double moved = not_known;            ///< |works|, summed, and the largest kinetic energy [J]
  std::string solver;
  int max_iterations = 0;

  /// An overlap of this part of the smallest radius can be seen.
  static constexpr double visible_overlap = 0.01;
  /// Gained energy of this part of what moved can be seen.
  static constexpr double visible_gain = 0.01;

  bool misses() const { return missed > 0; }
  bool overlaps() const { return deepest > visible_overlap * smallest_radius; }
  bool gains() const { return gained > visible_gain * moved; }
  /// Nothing has to be said.
  bool is_clean() const { return !misses() && !overlaps() && !gains(); }
};

/// Of a run's folder; without scene.toml only what the rows say.
RunTrust trust_of(const RunData& data);

/// One sentence on each thing, the finding first and what to do about it behind; a single one when
/// there is nothing to do.
std::vector<std::string> trust_words(const RunTrust& trust);

}  // namespace ballast
