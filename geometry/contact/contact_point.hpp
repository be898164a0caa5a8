#pragma once
// The input and output of contact detection: shapes, settings, contact points and the keys by which
// they are known from step to step.

#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// The half-space {x : normal.x >= 0} in the body frame of a wall; the wall's pose places it.
/// normal points into the free side, where the grains are.
struct Plane {
  Vec3 normal = Vec3::UnitZ();
};

/// A convex part of a body.
struct ConvexPart {
  const Polyhedron* polyhedron = nullptr;  ///< in its own frame; not owned
  Pose pose;                               ///< of that frame in the body frame
};

/// A body as detection sees it: a polyhedron (in its body frame), several of them, or a plane.
struct ContactShape {
  const Polyhedron* polyhedron = nullptr;  ///< not owned; null for a plane; the hull of any `parts`
  Plane plane = {};                        ///< used when polyhedron is null
  bool fixed = false;                  ///< carries no unknown: two fixed bodies are never a pair
  std::vector<ConvexPart> parts = {};  ///< empty: the polyhedron is the body
};

/// The polyhedra that a body consists of, each with its place in the body frame; none for a plane.
inline std::vector<ConvexPart> convex_parts(const ContactShape& shape) {
  if (!shape.parts.empty() || !shape.polyhedron) return shape.parts;
  return {{shape.polyhedron, Pose{}}};
}

struct DetectionSettings {
  int max_points = 4;     ///< per pair of polyhedra; the deepest is always kept
  double joint = 0.0;     ///< for pairs with a fixed body [m]; see ManifoldLimits
  double skin = 0.0;      ///< broad-phase margin [m]; 0 = chosen from the shapes
  bool use_cache = true;  ///< start from last step's axis; off: every pair from scratch (the same
                          ///< contacts, slower)
};

/// Counters of the last detect().
struct DetectionCounters {
  long candidate_pairs = 0;       ///< pairs in the broad phase's list
  long cached_separations = 0;    ///< pairs dismissed by the axis that separated them last time, or
                                  ///< because they cannot have met since (apart_below)
  long proved_axes = 0;           ///< pairs whose last axis was proved to be the best one again
  long full_tests = 0;            ///< pairs that needed the whole separating-axis search
  long manifolds = 0;             ///< pairs with at least one contact point
  long broad_phase_rebuilds = 0;  ///< since construction
};

/// One contact point between body a and body b. A plane is always a; of two polyhedra a has the
/// smaller index. contact_normal.hpp says how normal, position and gap are chosen.
struct ContactPoint {
  int body_a, body_b;
  std::uint64_t feature;  ///< key of the features that touch: unique within the
                          ///< pair, the same from step to step while they do
  Vec3 normal;            ///< unit, world frame, from a to b; one normal for all points of a pair
  Vec3 position;          ///< world frame [m], midway between the two surfaces
  double gap;  ///< signed distance along the normal at this point [m]; negative = overlap
};

/// The features that meet at a point. They do not name the reference face, so that a point keeps
/// its key when the reference changes from one body's face to the other's, or to the face beside
/// it.
enum class PointKind : std::uint8_t {
  vertex_of_a,  ///< a vertex of a over a face of b: the index in a, nothing in b
  vertex_of_b,
  edges,  ///< an edge of each
  sides   ///< two sides of the reference face that share no corner: caused by rounding only
};

/// The two top bits hold the kind, then 31 bits each hold the index in a and in b. The key of a
/// vertex of b is the vertex's own index.
inline std::uint64_t feature_key(PointKind kind, int a, int b) {
  constexpr std::uint64_t code[] = {1, 0, 2, 3};
  return code[static_cast<int>(kind)] << 62 | static_cast<std::uint64_t>(a) << 31 |
         static_cast<std::uint64_t>(b);
}

/// Vertex `index` of body 0 (a) or 1 (b).
inline std::uint64_t vertex_key(int body, int index) {
  return body == 0 ? feature_key(PointKind::vertex_of_a, index, 0)
                   : feature_key(PointKind::vertex_of_b, 0, index);
}

/// For bodies of several parts the upper 15 of a body's 31 bits name the part.
inline constexpr int most_key_features = 1 << 16, most_key_parts = 1 << 15;

/// The key of the feature between numbered parts of the bodies; `is_turned`: a and b change places.
inline std::uint64_t key_of_parts(std::uint64_t key, int part_a, int part_b, bool is_turned) {
  constexpr std::uint64_t low_bits = (std::uint64_t{1} << 31) - 1;
  std::uint64_t code = key >> 62;
  std::uint64_t a = (key >> 31 & low_bits) + static_cast<std::uint64_t>(part_a) * most_key_features;
  std::uint64_t b = (key & low_bits) + static_cast<std::uint64_t>(part_b) * most_key_features;
  if (is_turned) {
    std::swap(a, b);
    if (code < 2) code = 1 - code;  // a vertex of a becomes one of b, and the reverse
  }
  return code << 62 | a << 31 | b;
}

}  // namespace ballast
