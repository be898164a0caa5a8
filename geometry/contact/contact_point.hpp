#pragma once
// What contact detection takes and gives: shapes, settings, contact points, counters.

#include <cstdint>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// The half-space {x : normal.x >= 0} in the body frame of a wall; the wall's pose places it.
/// normal points into the free side, where the grains are.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
};

/// What detection knows of a body: a polyhedron (in its body frame) or a plane.
struct ContactShape {
  const Polyhedron* polyhedron = nullptr;  ///< not owned; null for a plane
  Plane plane;                             ///< used when polyhedron is null
  bool fixed = false;  ///< never moves and carries no unknown: two fixed bodies are never a pair
};

/// One contact point between body a and body b. A plane is always a; of two polyhedra a has the
/// smaller index.
struct ContactPoint {
  int body_a, body_b;
  std::uint64_t feature;  ///< which features touch; unique within the pair, the same from step to
                          ///< step while they do
  Vec3 normal;    ///< unit, world frame, from a to b. Face contact: the reference face's normal;
                  ///< edge-edge: the normalised cross product of the two edges; one normal for all
                  ///< points of a pair
  Vec3 position;  ///< world frame [m], midway between the two surfaces
  double gap;     ///< signed distance along the normal at this point [m]; negative = overlap
};

struct DetectionSettings {
  int max_points = 4;  ///< per pair of polyhedra; the deepest is always kept
  double skin = 0.0;   ///< broad-phase margin [m]; 0 = chosen from the shapes
  bool use_cache =
      true;  ///< start from last step's axis; off: every pair from scratch (same contacts, slower)
  /// > 0: a pair's points are held on to until its bodies have moved by more than this part of
  /// their circumradii against each other, or until refresh(). Contacts then depend on the poses
  /// since the last refresh(). Needs use_cache.
  double reuse_motion = 0.0;
  int refresh_steps =
      10;  ///< then: whoever steps calls refresh() when the number of steps is a multiple of this
};

/// Counters of the last detect().
struct DetectionCounters {
  long candidate_pairs = 0;       ///< pairs in the broad phase's list
  long cached_separations = 0;    ///< pairs dismissed by the axis that separated them last time, or
                                  ///< by what is left of its proven distance
  long proved_axes = 0;           ///< pairs whose last axis was proved to be the best still
  long full_tests = 0;            ///< pairs that needed the whole separating-axis search
  long reused = 0;                ///< pairs whose points were held on to
  long manifolds = 0;             ///< pairs with at least one contact point
  long broad_phase_rebuilds = 0;  ///< since construction

  DetectionCounters& operator+=(const DetectionCounters& other);
};

}  // namespace ballast
