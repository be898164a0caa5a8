#pragma once
// A pair and its separating axis -> the points where the two bodies touch or may touch within the step.

#include <span>
#include <vector>

#include "geometry/face_clipping.hpp"

namespace ballast {

struct ManifoldPoint {
  std::uint64_t key;  ///< unique within the pair
  Vec3 position;      ///< in a's frame, midway between the two surfaces [m]
  double gap;         ///< along the axis [m]; negative = overlap
};

/// Holds scratch memory; one per thread.
class ContactManifold {
 public:
  /// Points of the pair with gap <= alert, at most `max_points` of them, sorted by key. The axis must be the pair's
  /// best and its separation <= alert. The smallest gap equals the separation: the touching vertex is added if clipping
  /// lost it. Face: the other body's face at its touching vertex that opposes the reference face most is clipped by the
  /// reference face's sides; each corner has its own gap. Edges: the lines' closest points; where faces beside the two
  /// edges are nearly parallel, the corners of their common part as well, so that a flat contact whose best axis
  /// happens to be an edge pair's keeps its points. Valid until the next call.
  std::span<const ManifoldPoint> points(const ShapePair& pair, const SeparatingAxis& axis, double alert,
                                        int max_points);

 private:
  void edge_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert);
  void face_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert);
  void reduce(int max_points, double size);

  FaceClipper clipper_;
  std::vector<ClippedPoint> candidates_;  // within reach, in the polygon's order; reference body's frame
  std::vector<int> by_key_;               // candidates in the order of their keys
  std::vector<char> chosen_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace ballast
