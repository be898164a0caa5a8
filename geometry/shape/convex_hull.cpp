#include "geometry/shape/convex_hull.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/shape/area_vector.hpp"
#include "geometry/shape/close_pairs.hpp"
#include "geometry/shape/coplanar_faces.hpp"
#include "geometry/shape/face_loops.hpp"
#include "geometry/shape/qhull_loops.hpp"

namespace ballast {

namespace {

// Lengths below are relative to half the largest extent.

/// Points closer than this are one point.
constexpr double kWeld = 1e-9;
/// Thinner sets are flat: they would not outlive the tolerances that follow.
constexpr double kFlat = 1e-8;
/// qhull's own error bound, option 'E': it merges facets that are coplanar within a few of these. A
/// tenth of Polyhedron's tolerance, as a merged facet is flat only to several of them. The second
/// is for the rare sets whose detail is of just the first's size, where qhull's merging goes too
/// far or gives up: they are resolved instead.
constexpr double kMerge[] = {1e-10, 1e-14};
/// Corners of faces that rise less than this over the chord of their neighbours are dropped: they
/// would make needles, whose planes mean nothing. Above Polyhedron's tolerance of 1e-9 of a size
/// that is at most 2 sqrt(3) half-extents.
constexpr double kCorner = 4e-9;

/// Throws on NaN and on too few points; returns the points moved to their box's centre and scaled
/// to half-extent 1, so that qhull's tolerances are relative.
std::vector<Vec3> normalised(std::span<const Vec3> points) {
  if (points.size() < 4)
    throw InvalidPolyhedron("no convex hull: at least 4 points are needed, got " +
                            std::to_string(points.size()));
  Vec3 low = points[0], high = points[0];
  for (size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw InvalidPolyhedron("no convex hull: point " + std::to_string(i) +
                              " has a coordinate that is NaN or infinite");
    low = low.cwiseMin(points[i]);
    high = high.cwiseMax(points[i]);
  }
  const double half = 0.5 * (high - low).maxCoeff();
  if (!(half > 0.0)) throw InvalidPolyhedron("no convex hull: all points coincide");
  // The cube of the half-extent stands for the volume: no mass could
  // be computed where it overflows.
  if (!std::isfinite(half * half * half))
    throw InvalidPolyhedron("no convex hull: the volume overflows");
  std::vector<Vec3> scaled;
  for (const Vec3& p : points) scaled.push_back((p - 0.5 * (low + high)) / half);
  return scaled;
}

/// Throws when the points lie on a line or in a plane: thickness below kFlat.
void check_spatial(const std::vector<Vec3>& points) {
  const auto farthest = [&](auto distance) {
    return *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
      return distance(a) < distance(b);
    });
  };
  // Four points that span the set, each the farthest from what is there: a, a second one, c off the
  // line through both, and one off the plane of the three. Flat sets fail at c or at the last.
  const Vec3 a = farthest([&](const Vec3& p) { return (p - points[0]).norm(); });
  const Vec3 along = (farthest([&](const Vec3& p) { return (p - a).norm(); }) - a).normalized();
  const auto from_line = [&](const Vec3& p) { return (p - a - along * along.dot(p - a)).norm(); };
  const Vec3 c = farthest(from_line);
  if (!(from_line(c) > kFlat))
    throw InvalidPolyhedron("no convex hull: all points lie on one line");
  const Vec3 normal = along.cross(c - a).normalized();
  const auto from_plane = [&](const Vec3& p) { return std::abs(normal.dot(p - a)); };
  if (!(from_plane(farthest(from_plane)) > kFlat))
    throw InvalidPolyhedron("no convex hull: all points lie in one plane");
}

/// Ascending indices of the points, without those within kWeld of one that stays (the smaller index
/// stays).
std::vector<int> distinct(const std::vector<Vec3>& points) {
  const std::vector<int> first = first_close(points, kWeld);
  std::vector<int> kept;
  for (size_t i = 0; i < points.size(); ++i) {
    if (first[i] == static_cast<int>(i)) kept.push_back(static_cast<int>(i));
  }
  return kept;
}

/// The flattest corner of each face where it is flatter than kCorner, straight or re-entrant:
/// merging leaves such behind too. At most one per face and none beside another: once it is gone,
/// the hull of the other points may well keep the neighbour.
std::vector<int> flat_corners(const Loops& loops, const std::vector<Vec3>& points) {
  std::vector<int> flat;
  std::vector<bool> is_listed(points.size(), false);
  const auto listed = [&](int v) { return is_listed[static_cast<size_t>(v)]; };
  for (const auto& loop : loops) {
    const size_t n = loop.size();
    const Vec3 normal = area_vector(loop, points).normalized();
    double lowest = kCorner;
    int corner = -1;
    for (size_t k = 0; k < n; ++k) {
      // |in x out| is twice the triangle of a corner and its neighbours; over the chord |in + out|
      // between these it is the corner's height.
      const Vec3 in = points[loop[k]] - points[loop[(k + n - 1) % n]];
      const Vec3 out = points[loop[(k + 1) % n]] - points[loop[k]];
      const double height =
          normal.dot(in.cross(out)) / (in + out).norm();  // negative: re-entrant after merging
      if (height < lowest) {
        lowest = height;
        corner = loop[k];
      }
    }
    // One corner of a face a round: its neighbours may rise enough once it is gone.
    if (corner < 0 || std::any_of(loop.begin(), loop.end(), listed)) continue;
    flat.push_back(corner);
    is_listed[static_cast<size_t>(corner)] = true;
  }
  return flat;
}

/// Faces of the hull as canonical loops of point indices. Each round drops the corners that are too
/// flat and starts again without them: one round for almost all inputs.
Loops hull_loops(const std::vector<Vec3>& points, double merge) {
  std::vector<int> kept = distinct(points);
  while (kept.size() >= 4) {
    // Only the points that are left are handed over, under new numbers; what comes back is put into
    // the caller's numbers before it is judged.
    std::vector<double> coordinates;
    for (const int i : kept)
      coordinates.insert(coordinates.end(), points[i].begin(), points[i].end());
    Loops loops = qhull_loops(coordinates, merge);
    for (auto& loop : loops)
      for (int& v : loop) v = kept[v];
    make_canonical(loops, points);
    std::vector<int> flat = flat_corners(loops, points);
    if (flat.empty()) return loops;
    std::sort(flat.begin(), flat.end());
    std::erase_if(kept, [&](int i) { return std::binary_search(flat.begin(), flat.end(), i); });
  }
  throw InvalidPolyhedron("fewer than 4 distinct corners");
}

}  // namespace

Polyhedron convex_hull(std::span<const Vec3> points) {
  const std::vector<Vec3> scaled = normalised(points);
  check_spatial(scaled);
  // From qhull only the faces are taken; the solid is built from the caller's own coordinates, and
  // its constructor checks everything once more.
  try {
    return solid_of(points, hull_loops(scaled, kMerge[0]));
  } catch (const InvalidPolyhedron&) {
    // The finer attempt below decides.
  }
  try {
    return solid_of(points, hull_loops(scaled, kMerge[1]));
  } catch (const InvalidPolyhedron& error) {
    throw InvalidPolyhedron(
        std::string("no convex hull: the points are almost flat or degenerate: ") + error.what());
  }
}

Polyhedron convex_hull_of_mesh(const Polyhedron& mesh) {
  const std::vector<Vec3> scaled = normalised(mesh.vertices());
  // Back from the lengths of the constants above to metres.
  const double half = (mesh.vertex(0) - mesh.vertex(1)).norm() / (scaled[0] - scaled[1]).norm();
  const FaceGroups groups = coplanar_groups(mesh, 2.0 * kMerge[0] * half);
  if (std::optional<Loops> loops = joined_faces(mesh, groups, kCorner * half)) {
    make_canonical(*loops, scaled);
    try {
      if (flat_corners(*loops, scaled).empty()) return solid_of(mesh.vertices(), *loops);
    } catch (const InvalidPolyhedron&) {
      // Neighbours that are neither flat nor bent: qhull decides.
    }
  }
  return convex_hull(mesh.vertices());
}

}  // namespace ballast
