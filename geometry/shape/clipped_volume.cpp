#include "geometry/shape/clipped_volume.hpp"

#include <algorithm>

#include "geometry/shape/point_sets.hpp"

namespace ballast {

namespace {

/// Six times the volume between the origin and a flat polygon, positive when it is
/// counter-clockwise seen from beyond. corner(k): its k-th of `count` corners.
template <typename Corner>
double sixfold_cone(size_t count, const Corner& corner) {
  double sum = 0.0;
  for (size_t k = 2; k < count; ++k) sum += corner(0).dot(corner(k - 1).cross(corner(k)));
  return sum;
}

}  // namespace

double BoxClipper::volume(const Polyhedron& polyhedron, const Pose& pose, const Vec3& lo,
                          const Vec3& hi, double full_volume) {
  // Bounding spheres decide nearly all grains of a packing, which lie wholly outside the box or
  // wholly inside.
  const Vec3 radius = Vec3::Constant(polyhedron.circumradius());
  const Vec3 sphere_lo = pose.position - radius, sphere_hi = pose.position + radius;
  if ((sphere_lo.array() >= hi.array()).any() || (sphere_hi.array() <= lo.array()).any())
    return 0.0;
  if ((sphere_lo.array() >= lo.array()).all() && (sphere_hi.array() <= hi.array()).all())
    return full_volume;

  // Then the vertices' box in the world frame shows which planes cut the solid.
  const Mat3 rotation = pose.rotation.toRotationMatrix();
  world_.clear();
  for (const Vec3& vertex : polyhedron.vertices())
    world_.push_back(pose.position + rotation * vertex);
  const auto [low, high] = bounds_of(world_);
  if ((low.array() >= hi.array()).any() || (high.array() <= lo.array()).any()) return 0.0;

  // Along a direction that both planes cut, inside = (below hi) - (below lo). Every combination of
  // such terms is one `choice`, with a bit for each of these directions.
  HalfSpace cuts[3];
  int count = 0, both[3], both_count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const bool cut_lo = low[axis]<lo[axis], cut_hi = high[axis]> hi[axis];
    if (cut_lo && cut_hi) both[both_count++] = count;
    if (cut_hi)
      cuts[count++] = {axis, hi[axis], 1.0};
    else if (cut_lo)
      cuts[count++] = {axis, lo[axis], -1.0};
  }
  if (count == 0) return full_volume;
  double sum = 0.0;
  for (int choice = 0; choice < 1 << both_count; ++choice) {
    double sign = 1.0;
    for (int k = 0; k < both_count; ++k) {
      HalfSpace& cut = cuts[both[k]];
      const bool below_lo = choice >> k & 1;
      cut.at = below_lo ? lo[cut.axis] : hi[cut.axis];
      if (below_lo) sign = -sign;
    }
    sum += sign * cut_volume(polyhedron, {cuts, static_cast<size_t>(count)});
  }
  return std::clamp(sum, 0.0, full_volume);  // rounding
}

double BoxClipper::cut_volume(const Polyhedron& polyhedron, Cuts cuts) {
  // By the divergence theorem 3 V is the sum over faces of area times height over the apex, and a
  // triangle (a, b, c) of a face adds det(a, b, c) to 6 V. The faces that the cut makes lie in
  // planes through the apex and add nothing: they are never built.
  Vec3 apex = world_[0];  // arbitrary along directions that are not cut
  for (const HalfSpace& cut : cuts) apex[cut.axis] = cut.at;
  points_.clear();
  outside_.clear();
  for (const Vec3& vertex : world_) {
    const Vec3 point = vertex - apex;
    unsigned outside = 0;
    for (size_t k = 0; k < cuts.size(); ++k)
      outside |= unsigned{cuts[k].sign * point[cuts[k].axis] > 0.0} << k;
    points_.push_back(point);
    outside_.push_back(outside);
  }
  double sixfold = 0.0;
  for (int f = 0; f < polyhedron.face_count(); ++f)
    sixfold += sixfold_part(polyhedron.face(f), cuts);
  return sixfold / 6.0;
}

/// Six times the volume between the apex and the part of a face within all half-spaces.
double BoxClipper::sixfold_part(std::span<const int> loop, Cuts cuts) {
  // A face wholly outside one half-space adds 0; half-spaces that hold all its corners do not cut.
  unsigned any = 0, all = ~0u;
  for (const int v : loop) {
    any |= outside_[v];
    all &= outside_[v];
  }
  if (all != 0) return 0.0;
  if (any == 0)
    return sixfold_cone(loop.size(), [&](size_t k) -> const Vec3& { return points_[loop[k]]; });
  clip_face(loop, cuts, any);
  return sixfold_cone(polygon_.size(), [&](size_t k) -> const Vec3& { return polygon_[k]; });
}

/// Makes polygon_ the part of a face within the half-spaces named by the bits of `any`: Sutherland
/// & Hodgman, one half-space after the other.
void BoxClipper::clip_face(std::span<const int> loop, Cuts cuts, unsigned any) {
  polygon_.clear();
  for (const int v : loop) polygon_.push_back(points_[v]);
  for (size_t k = 0; k < cuts.size(); ++k) {
    if (!(any >> k & 1)) continue;
    const int axis = cuts[k].axis;
    next_polygon_.clear();
    // Every edge a -> b adds a, if a is inside, and the point where the edge crosses the plane.
    for (size_t i = 0; i < polygon_.size(); ++i) {
      const Vec3 &a = polygon_[i], &b = polygon_[i + 1 < polygon_.size() ? i + 1 : 0];
      const double height_a = cuts[k].sign * a[axis], height_b = cuts[k].sign * b[axis];
      if (height_a <= 0.0) next_polygon_.push_back(a);
      if ((height_a < 0.0 && height_b > 0.0) || (height_a > 0.0 && height_b < 0.0)) {
        next_polygon_.push_back(a + height_a / (height_a - height_b) * (b - a));
        next_polygon_.back()[axis] = 0.0;  // exactly, so that the cut face adds exactly nothing
      }
    }
    std::swap(polygon_, next_polygon_);
  }
}

}  // namespace ballast
