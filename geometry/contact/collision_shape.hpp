#pragma once
// A convex polyhedron laid out for contact detection, in tables that vector instructions run
// through.

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/shape/polyhedron.hpp"

namespace ballast {

/// Rows (x, y, z, w) stored column by column, padded to a multiple of 8 rows. A row stands for the
/// affine function d -> (x, y, z).d + w.
class AffineRows {
 public:
  AffineRows() = default;
  /// `padding`: w of the rows that fill up, chosen so that they never win the minimum or maximum
  /// that is sought.
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
  /// Of one row, to the last bit.
  double value(int row, const Vec3& d) const;

 private:
  int count_ = 0, padded_ = 0;
  std::vector<double> table_;
};

/// The sizes of a body that every test of a pair needs, in one cache line.
struct alignas(64) BodyBounds {
  Vec3 ball_centre = Vec3::Zero();  ///< of a ball inside the solid
  double ball_radius = 0.0;
  double circumradius = 0.0;  ///< largest distance of a vertex from the frame's origin
  double unevenness = 0.0;    ///< largest distance of a corner from its face's plane [m]: by
                              ///< rounding, or within the polyhedron's tolerance
};

/// Built once per shape. Neighbouring faces of a Polyhedron that lie in one plane (triangulated
/// boxes) are one face here, so that a contact patch does not end at a diagonal. Frame: that of the
/// polyhedron [m].
class CollisionShape {
 public:
  /// Two faces whose normals differ by less than this angle [rad] are one.
  static constexpr double coplanar_angle = 1e-9;

  // Each record holds everything that a visit to the feature needs, in one place: of 1200 shapes
  // only a few are in the cache.
  struct Face {
    Vec3 normal;       ///< outward, unit
    double offset;     ///< support of the whole polyhedron along the normal
    double isolation;  ///< smallest angle between this normal and any other face's, up to 1 [rad]
    int first_corner, corner_count;
  };
  struct Edge {
    Vec3 from, along;                ///< the tail, and head - tail
    Vec3 left_normal, right_normal;  ///< outward; seen from outside, face `left` runs tail -> head
    double length;
    /// Along the unit normal n of this edge and another one, u, every vertex but the two ends lies
    /// at least drop min(|left_normal.u|, |right_normal.u|) / |along x u| below the edge [m].
    double drop;
    int tail, head, left, right;
  };
  /// Corner k of a face's loop and the edge from there to corner k+1.
  struct Corner {
    int vertex, edge;
    Vec3 position;
  };
  /// The plane through that edge which stands on the face: inside the face outward.x <= offset.
  struct Side {
    Vec3 outward;  ///< unit, in the plane of the face
    double offset;
  };

  /// A face with its loop, whether it stands in the tables or in a copy of them.
  struct FaceView {
    const Face& face;
    std::span<const Corner> corners;
    std::span<const Side> sides;
  };

  explicit CollisionShape(const Polyhedron& polyhedron);

  /// Rows (position, 0); padding is far above every height.
  const AffineRows& vertices() const { return vertices_; }
  /// Rows (outward unit normal, -offset): the signed distance of a point to each face's plane.
  /// Padding is far inside.
  const AffineRows& faces() const { return face_rows_; }
  const Face& face(int f) const { return faces_[f]; }
  std::span<const Edge> edges() const { return edges_; }

  std::span<const Corner> corners(int f) const {
    return {corners_.data() + faces_[f].first_corner, corner_span(f)};
  }
  std::span<const Side> sides(int f) const {
    return {sides_.data() + faces_[f].first_corner, corner_span(f)};
  }
  FaceView view(int f) const { return {faces_[f], corners(f), sides(f)}; }
  /// Faces that have v in their plane, ascending.
  std::span<const int> vertex_faces(int v) const {
    return {vertex_faces_.data() + vertex_begin_[v],
            static_cast<size_t>(vertex_begin_[v + 1] - vertex_begin_[v])};
  }
  const BodyBounds& bounds() const { return bounds_; }
  double circumradius() const { return bounds_.circumradius; }

 private:
  size_t corner_span(int f) const { return static_cast<size_t>(faces_[f].corner_count); }
  std::vector<int> merge_coplanar(const Polyhedron& polyhedron);
  void build_faces(const Polyhedron& polyhedron, const std::vector<int>& patch);
  void measure_isolation();
  void build_sides(const Polyhedron& polyhedron, const std::vector<int>& patch);
  void build_vertex_faces(const Polyhedron& polyhedron, const std::vector<int>& patch);
  void build_ball(const Polyhedron& polyhedron);

  AffineRows vertices_, face_rows_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<Corner> corners_;
  std::vector<Side> sides_;
  std::vector<int> vertex_begin_, vertex_faces_;
  BodyBounds bounds_;
};

}  // namespace ballast
