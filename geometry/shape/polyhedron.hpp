#pragma once
// A convex polyhedron with everything that contact detection walks along: faces, edges, neighbours.

#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/shape/point_sets.hpp"

namespace ballast {

/// A mesh that is not a closed convex outward non-degenerate polyhedron; what() names the face,
/// edge or vertex.
class InvalidPolyhedron : public std::runtime_error {
 public:
  explicit InvalidPolyhedron(const std::string& what, int at_face = -1, int at_vertex = -1)
      : std::runtime_error(what), face(at_face), vertex(at_vertex) {}

  /// Where the defect is, for readers that know the line; -1 if it is no single face or vertex.
  int face, vertex;
};

/// Convex polyhedron, immutable, in its own frame [m]. Built once, shared by all bodies of its
/// shape. Thousands are kept, so all that follows from the faces is computed when asked for.
class Polyhedron {
 public:
  /// One undirected edge: its ends and the two faces that meet there. Seen from outside, face
  /// `left` runs tail -> head and face `right` runs head -> tail.
  struct Edge {
    int tail, head;
    int left, right;
  };

  /// `faces`: vertex loops, counter-clockwise seen from outside, any length >= 3 (coplanar polygons
  /// stay polygons).
  ///
  /// Throws InvalidPolyhedron unless the mesh is closed (each directed edge once, its reverse
  /// once), one piece (Euler), flat-faced, convex, outward, without zero-area faces, unused or
  /// repeated vertices, NaN or infinity. Neighbouring faces may be coplanar, but a face's corners
  /// must be strictly convex.
  ///
  /// `tolerance` is relative to the size (largest distance of a vertex from the vertices' mean): a
  /// vertex may lie so far off its face's plane or in front of another face; shorter edges and
  /// lower faces count as zero. `rounding`, also relative to the size, is how well the vertices are
  /// known, if not to double precision. The planes of small and thin faces are known badly, and
  /// vertices may in addition lie in front of one by as much as a rounding tilts it.
  Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces,
             double tolerance = 1e-9, double rounding = 0.0);

  /// The same faces with other vertices, one for each of this one's, in its order [m]. Throws as
  /// the constructor.
  Polyhedron with_vertices(std::vector<Vec3> vertices) const;

  /// The same solid seen from a frame at `origin` whose axes are the columns of `axes`, a rotation:
  /// each vertex p becomes axes^T (p - origin). It stays convex, which is not checked anew. Throws
  /// InvalidPolyhedron where rounding, far from `origin`, leaves a face that is no longer flat.
  Polyhedron in_frame(const Mat3& axes, const Vec3& origin) const;

  int vertex_count() const { return static_cast<int>(vertices_.size()); }
  int face_count() const { return static_cast<int>(normals_.size()); }
  int edge_count() const { return static_cast<int>(face_vertices_.size() / 2); }

  std::span<const Vec3> vertices() const { return vertices_; }
  const Vec3& vertex(int v) const { return vertices_[v]; }

  /// Vertices of face f, counter-clockwise from outside.
  std::span<const int> face(int f) const { return of_face(f, face_vertices_); }
  /// Faces across the edges of face f: neighbour k lies across face(f)[k] -> face(f)[k+1].
  std::span<const int> face_neighbours(int f) const { return of_face(f, face_neighbours_); }
  /// Outward unit normal of face f, and its offset: the solid is {x : normal(f).x <= offset(f) for
  /// all f}.
  const Vec3& normal(int f) const { return normals_[f]; }
  double offset(int f) const { return offsets_[f]; }
  std::span<const Vec3> normals() const { return normals_; }

  /// All edges, ordered by (tail, head), tail < head; made anew at every call.
  std::vector<Edge> edges() const;
  /// The faces that meet at each vertex, ascending; made anew at every call.
  std::vector<std::vector<int>> faces_by_vertex() const;

  /// Largest distance of a vertex from the origin, and the radius of the largest ball around the
  /// origin inside the solid (negative when the origin lies outside) [m].
  double circumradius() const { return circumradius_; }
  double inradius() const { return inradius_; }

 private:
  std::span<const int> of_face(int f, const std::vector<int>& all) const {
    return {all.data() + face_begin_[f], static_cast<size_t>(face_begin_[f + 1] - face_begin_[f])};
  }
  void measure_size();
  void build_faces(const std::vector<std::vector<int>>& faces);
  void join_faces();
  void check_one_piece() const;
  std::vector<double> build_planes(double tolerance);
  void check_convex(double tolerance, double rounding, const std::vector<double>& thinness) const;

  std::vector<Vec3> vertices_;
  // Largest distance of a vertex from the vertices' mean: the scale of the tolerances [m].
  double size_ = 0.0;
  std::vector<int> face_begin_, face_vertices_, face_neighbours_;
  std::vector<Vec3> normals_;
  std::vector<double> offsets_;
  double circumradius_ = 0.0, inradius_ = 0.0;
};

/// An axis-aligned box with full side lengths `size` [m], centred at the origin.
Polyhedron make_box(const Vec3& size);

}  // namespace ballast
