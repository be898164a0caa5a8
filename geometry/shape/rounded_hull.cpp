#include "geometry/shape/rounded_hull.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/coplanar_faces.hpp"
#include "geometry/shape/face_loops.hpp"
#include "geometry/shape/point_sets.hpp"

namespace ballast {
namespace {

struct Plane {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;
  double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// Where corners of joined faces meet the faces that they must be moved to. A face with three
/// corners is flat wherever they are, so only those with more are kept, under new numbers.
struct Incidences {
  std::vector<int> corners;       ///< vertices of the hull where a face that is kept has a corner
  std::vector<int> begin;         ///< corner k's faces are face[begin[k]] to before begin[k + 1]
  std::vector<int> face, corner;  ///< of each incidence, sorted by corner
  SortedByKey of_face;            ///< incidences of each face
};

Incidences find_incidences(const Loops& loops, int vertex_count) {
  std::vector<int> face_of, vertex_of;  // of each corner of a face that is kept
  int kept = 0;
  for (const auto& loop : loops) {
    if (loop.size() <= 3) continue;
    face_of.insert(face_of.end(), loop.size(), kept++);
    vertex_of.insert(vertex_of.end(), loop.begin(), loop.end());
  }
  const SortedByKey by_vertex = sorted_by_key(vertex_of, vertex_count);
  Incidences all;
  for (int v = 0; v < vertex_count; ++v) {
    if (by_vertex.of(v).empty()) continue;
    all.corners.push_back(v);
    all.begin.push_back(static_cast<int>(all.face.size()));
    for (const int i : by_vertex.of(v)) {
      all.face.push_back(face_of[static_cast<size_t>(i)]);
      all.corner.push_back(static_cast<int>(all.corners.size()) - 1);
    }
  }
  all.begin.push_back(static_cast<int>(all.face.size()));
  all.of_face = sorted_by_key(all.face, kept);
  return all;
}

/// Least squares through the corners of each face, outward from `inside`.
std::vector<Plane> fit_planes(const Incidences& all, std::span<const Vec3> position,
                              const Vec3& inside) {
  // The best plane in the sense of least squares passes through the mean m of the corners; its
  // normal is the eigenvector of the smallest eigenvalue of sum (x - m)(x - m)'.
  std::vector<Plane> planes(all.of_face.begin.size() - 1);
  for (size_t g = 0; g < planes.size(); ++g) {
    const std::span<const int> own = all.of_face.of(static_cast<int>(g));
    const auto corner = [&](int i) -> const Vec3& {
      return position[static_cast<size_t>(all.corner[static_cast<size_t>(i)])];
    };
    Vec3 mean = Vec3::Zero();
    for (const int i : own) mean += corner(i);
    mean /= static_cast<double>(own.size());
    Mat3 scatter = Mat3::Zero();
    for (const int i : own) scatter += (corner(i) - mean) * (corner(i) - mean).transpose();
    Plane& plane = planes[g];
    plane.normal = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors().col(0);
    if (plane.normal.dot(mean - inside) < 0.0) plane.normal = -plane.normal;
    plane.offset = plane.normal.dot(mean);
  }
  return planes;
}

/// Moves a corner the shortest way to where its faces' planes meet, as well as they do; returns how
/// far it was off the worst of them [m].
double move_to_planes(Vec3& corner, std::span<const int> faces, std::span<const Plane> planes) {
  // The shortest d with N d = -(heights over the planes), one row of N for each plane, in least
  // squares: three planes in general position meet in one point, more of them need not.
  Mat3 square = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  double worst = 0.0;
  for (const int f : faces) {
    const Plane& plane = planes[static_cast<size_t>(f)];
    const double height = plane.height(corner);
    square += plane.normal * plane.normal.transpose();
    right += height * plane.normal;
    worst = std::max(worst, std::abs(height));
  }
  // In general position N'N tells it, to all digits that the next turn needs.
  constexpr double parallel = 1e-10;
  if (faces.size() >= 3) {
    const Eigen::LDLT<Mat3> factor(square);
    const Vec3 pivots = factor.vectorD();
    if (pivots.minCoeff() > parallel * pivots.maxCoeff()) {
      corner -= factor.solve(right);
      return worst;
    }
  }
  // Planes that are nearly parallel tell nothing across their common direction: d leaves it out.
  const Eigen::SelfAdjointEigenSolver<Mat3> squares(square);
  const Vec3& value = squares.eigenvalues();  // growing
  for (int k = 0; k < 3; ++k) {
    const Vec3 axis = squares.eigenvectors().col(k);
    if (value[k] > parallel * value[2]) corner -= axis.dot(right) / value[k] * axis;
  }
  return worst;
}

/// Corners of three faces fit at once; where more faces meet, planes and corners give way to each
/// other by turns. Whether they come to agree; `size` [m] is that of the whole solid.
bool come_to_agree(const Incidences& all, std::vector<Vec3>& position, const Vec3& inside,
                   double size) {
  // Each turn shrinks what is left by much the same factor, so that ten of them tell whether all
  // will do: on a smooth surface of many small triangles they never would.
  // Many corners are given fewer: a solid whose corners have three faces each needs two.
  constexpr double most_moves = 2e6;
  const int most_turns =
      static_cast<int>(std::clamp(most_moves / static_cast<double>(position.size()), 4.0, 200.0));
  const double most_off = 1e-11 * size;
  double off = size, ten_ago = off;
  for (int turn = 0; turn < most_turns && off > 1e-14 * size; ++turn) {
    if (turn % 10 == 1) {
      const double at_end = off * std::pow(off / ten_ago, 0.1 * (most_turns - turn));
      if (off > most_off && at_end > most_off) return false;
      ten_ago = off;
    }
    const std::vector<Plane> planes = fit_planes(all, position, inside);
    off = 0.0;
    for (size_t k = 0; k < position.size(); ++k) {
      const std::span<const int> faces(all.face.data() + all.begin[k],
                                       all.face.data() + all.begin[k + 1]);
      off = std::max(off, move_to_planes(position[k], faces, planes));
    }
  }
  return off < most_off;
}

}  // namespace

Polyhedron rounded_hull(std::span<const Vec3> points, double rounding) {
  return rounded_hull(convex_hull(points), rounding);
}

Polyhedron rounded_hull(Polyhedron hull, double rounding) {
  const Bounds bounds = bounds_of(hull.vertices());
  const double size = bounds.largest_extent();
  const FaceGroups groups = coplanar_groups(hull, rounding * size);
  // Where every group is one face there is nothing to join, and fewer
  // than four planes bound no solid.
  if (groups.count == hull.face_count() || groups.count < 4) return hull;
  // Corners that go far say that the groups were wrong: then the hull of the points as they are is
  // the answer.
  const double most_moved = 100.0 * rounding * size;
  std::optional<Loops> loops = joined_faces(hull, groups, most_moved);
  if (!loops) return hull;
  const Incidences all = find_incidences(*loops, hull.vertex_count());
  std::vector<Vec3> moved;
  for (const int v : all.corners) moved.push_back(hull.vertex(v));
  if (!come_to_agree(all, moved, 0.5 * (bounds.low + bounds.high), size)) return hull;
  std::vector<Vec3> points(hull.vertices().begin(), hull.vertices().end());
  for (size_t k = 0; k < moved.size(); ++k) {
    Vec3& point = points[static_cast<size_t>(all.corners[k])];
    if (!((moved[k] - point).norm() < most_moved)) return hull;
    point = moved[k];
  }
  try {
    make_canonical(*loops, points);
    return solid_of(points, *loops);
  } catch (const InvalidPolyhedron&) {
    return hull;
  }
}

}  // namespace ballast
