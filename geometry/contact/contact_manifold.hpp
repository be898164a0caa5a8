#pragma once
// A pair and its separating axis -> the points where the two bodies touch or may touch within the
// step. Which points these are is the contact rule's business (contact_normal.hpp); here they are
// collected and, where there are too many, the most useful ones kept.

#include <span>
#include <vector>

#include "geometry/contact/contact_normal.hpp"

namespace ballast {

/// Holds scratch memory; one per thread.
class ContactManifold {
 public:
  /// Points of the pair with gap <= alert [m], at most `max_points` of them, sorted by key. The
  /// axis must be the pair's best and its separation <= alert. The smallest gap equals the
  /// separation: the touching vertex is added if clipping has lost it. Valid until the next call.
  std::span<const ManifoldPoint> points(const ShapePair& pair, const SeparatingAxis& axis,
                                        double alert, int max_points);

 private:
  void edge_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert);
  void face_candidates(const ShapePair& pair, const SeparatingAxis& axis, double alert);
  void reduce(int max_points, double size);

  FaceClipper clipper_;
  // Within reach, in the order of the polygon's corners; in the frame of the reference body.
  std::vector<ClippedPoint> candidates_;
  std::vector<int> by_key_;  // candidates in the order of their keys
  std::vector<char> chosen_;
  std::vector<ManifoldPoint> points_;
};

}  // namespace ballast
