#pragma once
// Exact volume of a convex polyhedron inside an axis-aligned box.

#include <span>
#include <vector>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Volume of (pose * polyhedron) within [lo, hi]. A workspace: no allocation once its buffers have
/// grown.
class BoxClipper {
 public:
  /// `full_volume`: that of the whole polyhedron [m^3], returned when the box holds it all. The
  /// polyhedron must be bounded by its circumradius about its origin, as every Polyhedron is. lo <=
  /// hi.
  double volume(const Polyhedron& polyhedron, const Pose& pose, const Vec3& lo, const Vec3& hi,
                double full_volume);

 private:
  /// The half-space {x : sign (x[axis] - at) <= 0}.
  struct HalfSpace {
    int axis;
    double at, sign;
  };
  /// At most one cut in each direction.
  using Cuts = std::span<const HalfSpace>;
  double cut_volume(const Polyhedron& polyhedron, Cuts cuts);
  double sixfold_part(std::span<const int> loop, Cuts cuts);
  void clip_face(std::span<const int> loop, Cuts cuts, unsigned any);

  std::vector<Vec3> world_;        // vertices, world frame [m]
  std::vector<Vec3> points_;       // vertices, relative to the apex o [m]
  std::vector<unsigned> outside_;  // per vertex: bit k set means outside half-space k
  std::vector<Vec3> polygon_, next_polygon_;
};

}  // namespace ballast
