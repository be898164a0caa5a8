#include "geometry/shape/rounded_hull.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/shape/area_vector.hpp"
#include "geometry/shape/convex_hull.hpp"

namespace ballast {
namespace {

struct Plane {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;
  double height(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// Each face's group: neighbours that lie in one plane to `reach` [m]. Large faces begin groups, as
/// the planes of small ones are the least certain.
std::vector<int> group_faces(const Polyhedron& hull, double reach, int& groups) {
  std::vector<double> area;
  for (int f = 0; f < hull.face_count(); ++f)
    area.push_back(area_vector(hull.face(f), hull.vertices()).norm());
  std::vector<int> order(area.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return area[static_cast<size_t>(a)] > area[static_cast<size_t>(b)];
  });
  std::vector<int> group(area.size(), -1);
  groups = 0;
  // A group grows across shared edges while all corners of the next face lie in the plane of
  // the seed. All are measured by that one plane, so that a group cannot creep around a
  // curved surface by small angles.
  for (const int seed : order) {
    if (group[static_cast<size_t>(seed)] >= 0) continue;
    const Plane plane{hull.normal(seed), hull.normal(seed).dot(hull.vertex(hull.face(seed)[0]))};
    const auto lies_in_it = [&](int f) {
      const std::span<const int> loop = hull.face(f);
      return std::all_of(loop.begin(), loop.end(),
                         [&](int v) { return std::abs(plane.height(hull.vertex(v))) <= reach; });
    };
    std::vector<int> reached{seed};
    group[static_cast<size_t>(seed)] = groups;
    for (size_t i = 0; i < reached.size(); ++i)
      for (const int next : hull.face_neighbours(reached[i]))
        if (group[static_cast<size_t>(next)] < 0 && lies_in_it(next)) {
          group[static_cast<size_t>(next)] = groups;
          reached.push_back(next);
        }
    ++groups;
  }
  return group;
}

/// A corner of the joined faces: a vertex where at least three of them meet.
struct Corner {
  Vec3 position;
  std::vector<int> groups;
};

std::vector<Corner> find_corners(const Polyhedron& hull, const std::vector<int>& group) {
  std::vector<Corner> corners;
  const SortedByKey faces = hull.faces_by_vertex();
  for (int v = 0; v < hull.vertex_count(); ++v) {
    Corner corner{hull.vertex(v), {}};
    for (const int f : faces.of(v)) corner.groups.push_back(group[static_cast<size_t>(f)]);
    std::sort(corner.groups.begin(), corner.groups.end());
    corner.groups.erase(std::unique(corner.groups.begin(), corner.groups.end()),
                        corner.groups.end());
    if (corner.groups.size() >= 3) corners.push_back(std::move(corner));
  }
  return corners;
}

/// Least squares through the corners of each group, outward from `inside`.
std::vector<Plane> fit_planes(const std::vector<Corner>& corners, int groups, const Vec3& inside) {
  // The best plane of a group in the sense of least squares passes through the mean m of its
  // corners; its normal is the eigenvector of the smallest eigenvalue of sum (x - m)(x - m)'.
  std::vector<Vec3> mean(static_cast<size_t>(groups), Vec3::Zero());
  std::vector<int> count(static_cast<size_t>(groups), 0);
  for (const Corner& corner : corners)
    for (const int g : corner.groups) {
      mean[static_cast<size_t>(g)] += corner.position;
      ++count[static_cast<size_t>(g)];
    }
  std::vector<Mat3> scatter(static_cast<size_t>(groups), Mat3::Zero());
  for (size_t g = 0; g < mean.size(); ++g) mean[g] /= std::max(1, count[g]);
  for (const Corner& corner : corners)
    for (const int g : corner.groups) {
      const Vec3 arm = corner.position - mean[static_cast<size_t>(g)];
      scatter[static_cast<size_t>(g)] += arm * arm.transpose();
    }
  std::vector<Plane> planes(mean.size());
  for (size_t g = 0; g < mean.size(); ++g) {
    Plane& plane = planes[g];
    plane.normal = Eigen::SelfAdjointEigenSolver<Mat3>(scatter[g]).eigenvectors().col(0);
    if (plane.normal.dot(mean[g] - inside) < 0.0) plane.normal = -plane.normal;
    plane.offset = plane.normal.dot(mean[g]);
  }
  return planes;
}

/// Moves a corner the shortest way to where its planes meet, as well as they do; returns how far it
/// was off the worst of them [m].
double move_to_planes(Corner& corner, const std::vector<Plane>& planes) {
  // The shortest d with N d = -(heights over the planes), one row of N for each plane, in least
  // squares: three planes in general position meet in one point, more of them need not.
  Eigen::MatrixXd normals(static_cast<Eigen::Index>(corner.groups.size()), 3);
  Eigen::VectorXd off(normals.rows());
  for (Eigen::Index k = 0; k < normals.rows(); ++k) {
    const Plane& plane = planes[static_cast<size_t>(corner.groups[static_cast<size_t>(k)])];
    normals.row(k) = plane.normal.transpose();
    off[k] = plane.height(corner.position);
  }
  corner.position -= normals.completeOrthogonalDecomposition().solve(off);
  return off.cwiseAbs().maxCoeff();
}

}  // namespace

Polyhedron rounded_hull(std::span<const Vec3> points, double rounding) {
  return rounded_hull(convex_hull(points), rounding);
}

Polyhedron rounded_hull(Polyhedron hull, double rounding) {
  Vec3 low = hull.vertex(0), high = low;
  for (const Vec3& p : hull.vertices()) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double size = (high - low).maxCoeff();
  int groups = 0;
  const std::vector<int> group = group_faces(hull, rounding * size, groups);
  // Where every group is one face there is nothing to join, and fewer
  // than four planes bound no solid.
  if (groups == hull.face_count() || groups < 4) return hull;
  std::vector<Corner> corners = find_corners(hull, group);
  const std::vector<Corner> before = corners;
  if (corners.size() < 4) return hull;
  // Corners of three faces fit at once; where more faces meet, planes and corners give way to each
  // other by turns. Each turn shrinks what is left by much the same factor, so that ten of them
  // tell whether all will do: on a smooth surface of many small triangles they never would.
  constexpr int most_turns = 200;
  const double most_off = 1e-11 * size;
  double off = size, ten_ago = off;
  for (int turn = 0; turn < most_turns && off > 1e-14 * size; ++turn) {
    if (turn % 10 == 1) {
      const double at_end = off * std::pow(off / ten_ago, 0.1 * (most_turns - turn));
      if (off > most_off && at_end > most_off) return hull;
      ten_ago = off;
    }
    const std::vector<Plane> planes = fit_planes(corners, groups, 0.5 * (low + high));
    off = 0.0;
    for (Corner& corner : corners) off = std::max(off, move_to_planes(corner, planes));
  }
  double moved = 0.0;
  std::vector<Vec3> positions;
  for (size_t k = 0; k < corners.size(); ++k) {
    moved = std::max(moved, (corners[k].position - before[k].position).norm());
    positions.push_back(corners[k].position);
  }
  // Planes and corners that do not come to agree, or corners that went far, say that the groups
  // were wrong: then the hull of the points as they are is the answer.
  if (!(off < most_off && moved < 100.0 * rounding * size)) return hull;
  try {
    Polyhedron joined = convex_hull(positions);
    return joined.face_count() == groups ? joined : hull;
  } catch (const InvalidPolyhedron&) {
    return hull;
  }
}

}  // namespace ballast
