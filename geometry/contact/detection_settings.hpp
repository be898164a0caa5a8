#pragma once
// How contacts are looked for, and how much work a detection was.

namespace ballast {

struct DetectionSettings {
  int max_points = 4;     ///< per pair of polyhedra; the deepest is always kept
  double skin = 0.0;      ///< broad-phase margin [m]; 0 = chosen from the shapes
  bool use_cache = true;  ///< start from last step's axis; off: every pair from scratch (the same
                          ///< contacts, slower)
  /// > 0: a pair's points are held on to until its bodies have moved by more than this part of
  /// their circumradii against each other, or until refresh(). Contacts then depend on the poses
  /// since the last refresh(). Needs use_cache.
  double reuse_motion = 0.0;
  /// With reuse_motion: the caller calls refresh() whenever the number of steps is a multiple of
  /// this.
  int refresh_steps = 10;
};

/// Counters of the last detect().
struct DetectionCounters {
  long candidate_pairs = 0;       ///< pairs in the broad phase's list
  long cached_separations = 0;    ///< pairs dismissed by the axis that separated them last time, or
                                  ///< by the rest of its proven distance
  long proved_axes = 0;           ///< pairs whose last axis was proved to be the best one again
  long full_tests = 0;            ///< pairs that needed the whole separating-axis search
  long reused = 0;                ///< pairs whose points were held on to
  long manifolds = 0;             ///< pairs with at least one contact point
  long broad_phase_rebuilds = 0;  ///< since construction

  DetectionCounters& operator+=(const DetectionCounters& other) {
    candidate_pairs += other.candidate_pairs;
    cached_separations += other.cached_separations;
    proved_axes += other.proved_axes;
    full_tests += other.full_tests;
    reused += other.reused;
    manifolds += other.manifolds;
    broad_phase_rebuilds += other.broad_phase_rebuilds;
    return *this;
  }
};

}  // namespace ballast
