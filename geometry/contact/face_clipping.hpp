#pragma once
// A face of one body clipped by the sides of a face of the other (Sutherland-Hodgman), with names
// for the corners.

#include <span>
#include <vector>

#include "geometry/contact/contact_point.hpp"
#include "geometry/contact/separating_axis.hpp"

namespace ballast {

/// A corner of a clipped polygon.
struct ClippedPoint {
  Vec3 position;  ///< in the reference body's frame [m]
  double height;  ///< over the reference face [m]; set by the contact rule (contact_normal.hpp)
  std::uint64_t key;
  int next_edge;  ///< runs to the next corner: an edge e of the incident body, or ~k for side k of
                  ///< the reference face
};

/// Holds scratch memory; one per thread.
class FaceClipper {
 public:
  /// Room for every polygon of ordinary grains: buffers change places while clipping, so each must
  /// be large enough at once.
  FaceClipper() {
    polygon_.reserve(room);
    clipped_.reserve(room);
    distance_.reserve(room);
  }

  using FaceView = CollisionShape::FaceView;

  /// The part of face `incident` of body 1 - `reference` that lies within the prism on face `face`
  /// of body `reference`, along the face's normal, counter-clockwise seen from the incident body's
  /// outside. Corners up to `thickness` [m] outside a side count as inside and stay where they are.
  /// Valid until the next call.
  std::span<ClippedPoint> clip(const PairFrame& pair, int reference, const FaceView& face,
                               const FaceView& incident, double thickness);
  /// The same for a prism along another unit direction, in the reference body's frame.
  std::span<ClippedPoint> clip_along(const PairFrame& pair, int reference, const FaceView& face,
                                     const FaceView& incident, const Vec3& direction,
                                     double thickness);

 private:
  static constexpr size_t room = 128;
  struct Plane {
    Vec3 outward;
    double offset;
  };
  void start(const PairFrame& pair, int reference, const FaceView& incident);
  void clip_by_side(int reference, const FaceView& face, int k, const Plane& plane,
                    double thickness);

  std::vector<ClippedPoint> polygon_, clipped_;
  std::vector<double> distance_;
};

}  // namespace ballast
