#pragma once
// A convex polyhedron laid out for contact detection, in tables that vector instructions run
// through.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Rows (x, y, z, w) stored column by column, padded to a multiple of 8 rows. A row stands for the
/// affine function d -> (x, y, z).d + w.
class AffineRows {
 public:
  AffineRows() = default;
  /// `padding`: the w of the padding rows. It must be such that they never win the minimum or
  /// maximum that is sought.
  AffineRows(int count, double padding);

  int count() const { return count_; }
  int padded() const { return padded_; }
  void set(int row, const Vec3& xyz, double w);
  Vec3 xyz(int row) const {
    return Vec3(table_[row], table_[padded_ + row], table_[2 * static_cast<size_t>(padded_) + row]);
  }
  double w(int row) const { return table_[3 * static_cast<size_t>(padded_) + row]; }

  /// values[i] = xyz(i).d + w(i) for all padded() rows.
  void evaluate(const Vec3& d, double* values) const;
  /// Prefetches the rows, which lie in main memory when there are thousands of shapes.
  void prefetch() const {
    constexpr size_t line = 8, most = 32 * line;  // numbers; a usual grain's rows take 16 lines
    for (size_t k = 0; k < std::min(table_.size(), most); k += line)
      __builtin_prefetch(table_.data() + k);
  }

 private:
  int count_ = 0, padded_ = 0;
  std::vector<double> table_;
};

/// A vertex's height along direction d from the origin of its frame [m], added up in the order of
/// AffineRows::evaluate.
inline double vertex_height(const Vec3& d, const Vec3& vertex) {
  return ((d.x() * vertex.x() + d.y() * vertex.y()) + d.z() * vertex.z()) + 0.0;
}

/// The sizes of a body that every test of a pair needs, in one cache line.
struct alignas(64) BodyBounds {
  Vec3 ball_centre = Vec3::Zero();  ///< of a ball inside the solid
  double ball_radius = 0.0;
  double circumradius = 0.0;     ///< largest distance of a vertex from the frame's origin
  double planarity_error = 0.0;  ///< largest distance of a corner from its face's plane [m]: by
                                 ///< rounding, or within the polyhedron's tolerance
};

/// Built once per shape, in the frame of the polyhedron [m]. Coplanar neighbouring faces are best
/// joined before, as convex_hull() and read_mesh() do: a contact patch ends at their edge.
///
/// It stores only positions, planes and which feature borders on which: with thousands of shapes,
/// one for each grain, few are in the cache, and each byte counts. The records of faces, edges,
/// corners and sides follow from these and are computed when asked for, always to the same bits.
class CollisionShape {
 public:
  struct Face {
    Vec3 normal;       ///< outward, unit
    double offset;     ///< support of the whole polyhedron along the normal
    double isolation;  ///< no other face's normal is nearer than this angle, at most 1 [rad]
  };
  /// The ends and the two faces of an edge. Seen from outside, face `left` runs tail -> head and
  /// face `right` runs head -> tail.
  struct EdgeEnds {
    std::uint16_t tail, head, left, right;
  };
  struct Edge : EdgeEnds {
    Vec3 from, along;                ///< the tail, and head - tail
    Vec3 left_normal, right_normal;  ///< outward
    double length;
    /// Along the common unit normal of this edge and another edge u, every vertex but the two ends
    /// lies at least drop min(|left_normal.u|, |right_normal.u|) / |along x u| below the edge [m].
    float drop;
  };
  /// Corner k of a face's loop and the edge from there to corner k+1.
  struct Corner {
    int vertex, edge;
    Vec3 position;
  };
  /// The plane through that edge, perpendicular to the face: inside the face outward.x <= offset.
  struct Side {
    Vec3 outward;  ///< unit, in the plane of the face
    double offset;
  };

  /// A face with its corners and sides.
  struct FaceView {
    const Face& face;
    std::span<const Corner> corners;
    std::span<const Side> sides;
  };
  /// Storage for a face with any number of corners.
  struct FaceTable {
    Face face;
    std::vector<Corner> corners;
    std::vector<Side> sides;
    FaceView view() const { return {face, corners, sides}; }
  };

  /// Throws InvalidPolyhedron if its faces have more than 65535 corners in total, as triangles on
  /// 11,000 vertices do.
  explicit CollisionShape(const Polyhedron& polyhedron);

  /// Rows (position, 0); padding is far above every height.
  const AffineRows& vertices() const { return vertices_; }
  /// Rows (outward unit normal, -offset): the signed distance of a point to each face's plane.
  /// Padding is far inside.
  const AffineRows& faces() const { return faces_; }
  Face face(int f) const { return {faces_.xyz(f), -faces_.w(f), isolation_[f]}; }
  int edge_count() const { return static_cast<int>(drop_.size()); }
  EdgeEnds edge_ends(int e) const {
    return {edges_[4 * e], edges_[4 * e + 1], edges_[4 * e + 2], edges_[4 * e + 3]};
  }
  Edge edge(int e) const;
  int corner_count(int f) const { return first_corner_[f + 1] - first_corner_[f]; }
  Corner corner(int f, int k) const;
  Side side(int f, int k) const;
  void write(int f, FaceTable& table) const;

  /// The faces with v as a corner are vertex_face(v, k), 0 <= k < vertex_face_count(v), ascending.
  int vertex_face_count(int v) const { return vertex_begin_[v + 1] - vertex_begin_[v]; }
  int vertex_face(int v, int k) const { return vertex_faces_[vertex_begin_[v] + k]; }
  const BodyBounds& bounds() const { return bounds_; }
  double circumradius() const { return bounds_.circumradius; }

 private:
  std::vector<int> build_faces(const Polyhedron& polyhedron);
  void measure_isolation();
  void build_edges(const Polyhedron& polyhedron, std::span<const int> corners);
  double drop_below(const EdgeEnds& edge, const Polyhedron& polyhedron) const;
  void build_vertex_faces(const Polyhedron& polyhedron);
  void build_ball(const Polyhedron& polyhedron);

  AffineRows vertices_, faces_;
  // Lower bounds for proofs; they still hold when rounded down to single precision.
  std::vector<float> isolation_;  // of each face
  std::vector<float> drop_;       // of each edge
  // Indices of features, in two bytes each.
  std::vector<std::uint16_t> edges_;         // tail, head, left, right of each edge
  std::vector<std::uint16_t> first_corner_;  // of each face, then the end
  std::vector<std::uint16_t> corner_edge_;   // the edge of each corner, face by face
  std::vector<std::uint16_t> vertex_begin_, vertex_faces_;
  BodyBounds bounds_;
};

inline CollisionShape::Edge CollisionShape::edge(int e) const {
  const EdgeEnds ends = edge_ends(e);
  const Vec3 from = vertices_.xyz(ends.tail), along = vertices_.xyz(ends.head) - from;
  return {ends, from, along, faces_.xyz(ends.left), faces_.xyz(ends.right), along.norm(), drop_[e]};
}

inline CollisionShape::Corner CollisionShape::corner(int f, int k) const {
  const int e = corner_edge_[first_corner_[f] + k];
  const EdgeEnds ends = edge_ends(e);
  const int vertex = ends.left == f ? ends.tail : ends.head;
  return {vertex, e, vertices_.xyz(vertex)};
}

inline CollisionShape::Side CollisionShape::side(int f, int k) const {
  const EdgeEnds ends = edge_ends(corner_edge_[first_corner_[f] + k]);
  const bool is_left = ends.left == f;
  const Vec3 from = vertices_.xyz(is_left ? ends.tail : ends.head);
  const Vec3 to = vertices_.xyz(is_left ? ends.head : ends.tail);
  // With the face on the left of its side, along x normal points out of the face within its plane.
  const Vec3 outward = (to - from).cross(faces_.xyz(f)).normalized();
  return {outward, std::max(outward.dot(from), outward.dot(to))};
}

}  // namespace ballast
