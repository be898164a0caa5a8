#include "geometry/shape/convex_hull.hpp"

#include <libqhull_r/qhull_ra.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "platform/text.hpp"

namespace ballast {

namespace {

/// Faces as closed loops of point indices.
using Loops = std::vector<std::vector<int>>;

// Lengths below are relative to half the largest extent.

/// Points closer than this are one point.
constexpr double weld = 1e-9;
/// Thinner sets count as flat: they would not survive the tolerances that follow.
constexpr double thinnest = 1e-8;

/// Decides which facets are one face, and which points are no corner.
struct Tolerance {
  /// qhull's own error bound, option 'E': it merges facets that are coplanar within a few of these.
  double merge;
  /// Corners of faces that rise less than this over the chord of their neighbours are dropped: they
  /// would make needles, whose planes mean nothing.
  double corner;
  /// The most rounds of dropping flat corners, of which a curve of many points has hundreds.
  int most_rounds = 1 << 20;
};
/// merge: a tenth of Polyhedron's tolerance, as a merged facet is flat only to several times merge.
/// corner: above that tolerance of 1e-9 of a size that is at most 2 sqrt(3) half-extents.
constexpr Tolerance exact_tolerance{1e-10, 4e-9};
/// For the rare sets with details of just the size of exact_tolerance, where qhull's merging goes
/// too far or gives up: here the details are resolved.
constexpr Tolerance finer_tolerance{1e-14, 4e-9};

/// The corners of a facet, one after the other. `qh`: the name that qhull's macros expect.
std::vector<int> loop_of(qhT* qh, facetT* facet) {
  std::vector<int> vertices;
  vertexT *vertex, **vertexp;
  FOREACHvertex_(facet->vertices) vertices.push_back(qh_pointid(qh, vertex->point));
  if (facet->simplicial) return vertices;
  // a merged facet's vertices are unordered: chain its ridges, which are its edges in 3-d
  std::vector<std::pair<int, int>> links;
  ridgeT *ridge, **ridgep;
  FOREACHridge_(facet->ridges) {
    links.emplace_back(qh_pointid(qh, SETfirstt_(ridge->vertices, vertexT)->point),
                       qh_pointid(qh, SETsecondt_(ridge->vertices, vertexT)->point));
  }
  // Goes from corner to corner along the ridge that does not lead back, until the loop closes.
  std::vector<int> chain{links.front().first};
  for (int at = links.front().second; at != chain.front();) {
    chain.push_back(at);
    const auto next = std::find_if(links.begin(), links.end(), [&](const auto& link) {
      const int previous = chain[chain.size() - 2];
      return (link.first == at && link.second != previous) ||
             (link.second == at && link.first != previous);
    });
    if (next == links.end() || chain.size() > links.size())
      throw InvalidPolyhedron("a face of the hull is no simple loop");
    at = next->first == at ? next->second : next->first;
  }
  return chain;
}

/// Vertex loops of the merged facets, in qhull's order of facets; orientation and starting vertex
/// as they come.
Loops qhull_loops(std::vector<double>& coordinates, double merge) {
  // Takes qhull's messages, which are written for its own users.
  const std::unique_ptr<FILE, int (*)(FILE*)> nowhere(std::fopen("/dev/null", "w"), std::fclose);
  qhT memory;
  qhT* qh = &memory;
  qh_zero(qh, nowhere.get());
  // qhull keeps two stores: large blocks, and a pool of small ones that is freed separately.
  const auto release = [](qhT* used) {
    qh_freeqhull(used, !qh_ALL);
    int blocks, bytes;
    qh_memfreeshort(used, &blocks, &bytes);
  };
  const std::unique_ptr<qhT, decltype(release)> owner(qh, release);
  // Pp: no warnings about precision. qhull wants the text writable.
  std::string text = printed("qhull Pp E%g", merge);
  const int code = qh_new_qhull(qh, 3, static_cast<int>(coordinates.size() / 3), coordinates.data(),
                                False, text.data(), nullptr, nowhere.get());
  if (code != qh_ERRnone)
    throw InvalidPolyhedron("their hull is thinner than its numbers are exact");
  Loops loops;
  facetT* facet;
  FORALLfacets { loops.push_back(loop_of(qh, facet)); }
  return loops;
}

/// Half the largest extent. Throws on NaN and on too few points.
double half_extent(std::span<const Vec3> points) {
  if (points.size() < 4)
    throw InvalidPolyhedron("no convex hull: at least 4 points are needed, got " +
                            std::to_string(points.size()));
  for (size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw InvalidPolyhedron("no convex hull: point " + std::to_string(i) +
                              " has a coordinate that is NaN or infinite");
  const double half = 0.5 * bounds_of(points).largest_extent();
  if (!(half > 0.0)) throw InvalidPolyhedron("no convex hull: all points coincide");
  // The cube of the half-extent stands for the volume: no mass could
  // be computed where it overflows.
  if (!std::isfinite(half * half * half))
    throw InvalidPolyhedron("no convex hull: the volume overflows");
  return half;
}

/// Throws when the points lie on a line or in a plane: thickness below thinnest.
void check_spatial(const std::vector<Vec3>& points) {
  const auto farthest = [&](auto distance) {
    return *std::ranges::max_element(points, {}, distance);
  };
  // Four points span the set, each the farthest from those before: a, a second one, c off the line
  // through both, and one off the plane of the three. Flat sets fail at c or at the last.
  const Vec3 a = farthest([&](const Vec3& p) { return (p - points[0]).norm(); });
  const Vec3 along = (farthest([&](const Vec3& p) { return (p - a).norm(); }) - a).normalized();
  const auto from_line = [&](const Vec3& p) { return (p - a - along * along.dot(p - a)).norm(); };
  const Vec3 c = farthest(from_line);
  if (!(from_line(c) > thinnest))
    throw InvalidPolyhedron("no convex hull: all points lie on one line");
  const Vec3 normal = along.cross(c - a).normalized();
  const auto from_plane = [&](const Vec3& p) { return std::abs(normal.dot(p - a)); };
  if (!(from_plane(farthest(from_plane)) > thinnest))
    throw InvalidPolyhedron("no convex hull: all points lie in one plane");
}

/// The points moved to their box's centre and scaled to half-extent 1, so that qhull's tolerances
/// are relative. Throws where they span no solid.
std::vector<Vec3> normalised(std::span<const Vec3> points) {
  const double half = half_extent(points);
  const Bounds box = bounds_of(points);
  std::vector<Vec3> scaled;
  for (const Vec3& p : points) scaled.push_back((p - 0.5 * (box.low + box.high)) / half);
  check_spatial(scaled);
  return scaled;
}

/// Ascending indices of the points, without those within weld of one that stays (the smaller index
/// stays).
std::vector<int> distinct(const std::vector<Vec3>& points) {
  const std::vector<int> first = first_close(points, weld);
  std::vector<int> kept;
  for (size_t i = 0; i < points.size(); ++i)
    if (first[i] == static_cast<int>(i)) kept.push_back(static_cast<int>(i));
  return kept;
}

/// Puts the loops of a convex solid in one order that does not depend on who listed them: outward,
/// each from its smallest index, in ascending order.
void make_canonical(Loops& loops, std::span<const Vec3> points) {
  Vec3 inside = Vec3::Zero();
  double count = 0.0;
  for (const auto& loop : loops) {
    for (const int v : loop) inside += points[v];
    count += static_cast<double>(loop.size());
  }
  inside /= count;
  for (auto& loop : loops) {
    if (area_vector(loop, points).dot(points[loop[0]] - inside) < 0.0)
      std::reverse(loop.begin(), loop.end());
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
}

/// The solid of these outward loops. Its vertices keep the order of the points; points that are in
/// no loop are left out. Throws InvalidPolyhedron as Polyhedron's constructor.
Polyhedron solid_of(std::span<const Vec3> points, Loops loops) {
  std::vector<int> index(points.size(), -1);
  for (const auto& loop : loops)
    for (const int v : loop) index[v] = 0;
  std::vector<Vec3> vertices;
  for (size_t i = 0; i < points.size(); ++i) {
    if (index[i] < 0) continue;
    index[i] = static_cast<int>(vertices.size());
    vertices.push_back(points[i]);
  }
  for (auto& loop : loops)
    for (int& v : loop) v = index[v];
  return Polyhedron(std::move(vertices), loops);
}

/// The flattest corner of each face if it is flatter than `lowest_kept`; it may be straight or
/// re-entrant, as merging leaves such corners too. At most one per face and none beside another:
/// once one is gone, the hull of the other points may well keep its neighbour.
std::set<int> flat_corners(const Loops& loops, const std::vector<Vec3>& points,
                           double lowest_kept) {
  std::set<int> flat;
  for (const auto& loop : loops) {
    const size_t n = loop.size();
    const Vec3 normal = area_vector(loop, points).normalized();
    double lowest = lowest_kept;
    int corner = -1;
    for (size_t k = 0; k < n; ++k) {
      // |in x out| is twice the triangle of a corner and its neighbours; over the chord |in + out|
      // between these it is the corner's height.
      const Vec3 in = points[loop[k]] - points[loop[(k + n - 1) % n]];
      const Vec3 out = points[loop[(k + 1) % n]] - points[loop[k]];
      const double height = normal.dot(in.cross(out)) / (in + out).norm();
      if (height < lowest) {
        lowest = height;
        corner = loop[k];
      }
    }
    if (corner >= 0 && std::ranges::none_of(loop, [&](int v) { return flat.contains(v); }))
      flat.insert(corner);
  }
  return flat;
}

/// Faces of the hull as canonical loops of point indices. Each round drops the corners that are too
/// flat and starts again without them: one round for almost all inputs.
Loops hull_loops(const std::vector<Vec3>& points, const Tolerance& tolerance) {
  std::vector<int> kept = distinct(points);
  for (int round = 0; kept.size() >= 4; ++round) {
    if (round == tolerance.most_rounds)
      throw InvalidPolyhedron("faces with many nearly straight corners");
    // qhull gets only the points that are left, under new indices. Its loops are put back into the
    // caller's indices before they are judged.
    std::vector<double> coordinates;
    for (const int i : kept)
      coordinates.insert(coordinates.end(), points[i].begin(), points[i].end());
    Loops loops = qhull_loops(coordinates, tolerance.merge);
    for (auto& loop : loops)
      for (int& v : loop) v = kept[v];
    make_canonical(loops, points);
    const std::set<int> flat = flat_corners(loops, points, tolerance.corner);
    if (flat.empty()) return loops;
    std::erase_if(kept, [&](int i) { return flat.contains(i); });
  }
  throw InvalidPolyhedron("fewer than 4 distinct corners");
}

/// Moves corners to where the planes of their faces meet: by turns it fits each face's plane to its
/// corners by least squares and moves each corner the shortest way to its planes. Triangles are
/// flat wherever their corners are, so only larger faces count. Returns whether all come to agree.
bool flatten(const Loops& loops, std::vector<Vec3>& points) {
  constexpr int most_turns = 200;  // corners of three faces need two
  constexpr double most_off = 1e-11;
  std::vector<std::vector<int>> faces_at(points.size());
  std::vector<int> large;
  for (size_t f = 0; f < loops.size(); ++f) {
    if (loops[f].size() == 3) continue;
    for (const int v : loops[f]) faces_at[v].push_back(static_cast<int>(large.size()));
    large.push_back(static_cast<int>(f));
  }
  std::vector<Vec3> normal(large.size()), centre(large.size());
  // Squared singular values below this part of the largest are ignored: nearly parallel planes.
  constexpr double parallel = 1e-10;
  double off = 1.0;
  for (int turn = 0; turn < most_turns && off > 1e-14; ++turn) {
    for (size_t k = 0; k < large.size(); ++k) {
      const std::vector<int>& loop = loops[large[k]];
      centre[k].setZero();
      for (const int v : loop) centre[k] += points[v] / static_cast<double>(loop.size());
      Mat3 scatter = Mat3::Zero();
      for (const int v : loop)
        scatter += (points[v] - centre[k]) * (points[v] - centre[k]).transpose();
      // The plane lies across the direction in which the corners scatter least.
      normal[k] = Eigen::SelfAdjointEigenSolver<Mat3>(scatter).eigenvectors().col(0);
    }
    off = 0.0;
    for (size_t v = 0; v < points.size(); ++v) {
      if (faces_at[v].empty()) continue;
      Mat3 square = Mat3::Zero();
      Vec3 pull = Vec3::Zero();
      for (const int k : faces_at[v]) {
        const double height = normal[k].dot(points[v] - centre[k]);
        off = std::max(off, std::abs(height));
        square += normal[k] * normal[k].transpose();
        pull += height * normal[k];
      }
      const Eigen::SelfAdjointEigenSolver<Mat3> axes(square);
      for (int i = 0; i < 3; ++i)
        if (axes.eigenvalues()[i] > parallel * axes.eigenvalues()[2]) {
          const Vec3 axis = axes.eigenvectors().col(i);
          points[v] -= axis * (axis.dot(pull) / axes.eigenvalues()[i]);
        }
    }
  }
  return off < most_off;
}

/// The largest distance of a point outside a face's plane [m], or 0.
double farthest_outside(const Polyhedron& solid, std::span<const Vec3> points) {
  double farthest = 0.0;
  for (int f = 0; f < solid.face_count(); ++f)
    for (const Vec3& p : points)
      farthest = std::max(farthest, solid.normal(f).dot(p) - solid.offset(f));
  return farthest;
}

}  // namespace

Polyhedron convex_hull(std::span<const Vec3> points) {
  const std::vector<Vec3> scaled = normalised(points);
  // Only the faces are taken from qhull; the solid is built from the caller's own coordinates, and
  // its constructor checks everything once more.
  try {
    return solid_of(points, hull_loops(scaled, exact_tolerance));
  } catch (const InvalidPolyhedron&) {
    // The finer attempt below decides.
  }
  try {
    return solid_of(points, hull_loops(scaled, finer_tolerance));
  } catch (const InvalidPolyhedron& error) {
    throw InvalidPolyhedron(
        std::string("no convex hull: the points are almost flat or degenerate: ") + error.what());
  }
}

Polyhedron rounded_hull(std::span<const Vec3> points, double rounding) {
  const std::vector<Vec3> scaled = normalised(points);
  const double half = half_extent(points);
  try {
    const Loops loops = hull_loops(scaled, {rounding, 40.0 * rounding, /*most_rounds=*/6});
    std::vector<Vec3> moved = scaled;
    if (flatten(loops, moved)) {
      std::vector<Vec3> corners;
      for (size_t v = 0; v < points.size(); ++v)
        corners.push_back(points[v] + half * (moved[v] - scaled[v]));
      const Polyhedron solid = solid_of(corners, loops);
      if (farthest_outside(solid, points) < 10.0 * rounding * half) return solid;
    }
  } catch (const InvalidPolyhedron&) {
    // Facets were joined that are not one face.
  }
  return convex_hull(points);
}

}  // namespace ballast
