#pragma once
// A convex polyhedron with everything that contact detection walks along: faces, edges, neighbours.

#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// A mesh that is not a closed convex outward non-degenerate polyhedron; what() names the face,
/// edge or vertex.
class InvalidPolyhedron : public std::runtime_error {
 public:
  explicit InvalidPolyhedron(const std::string& what, int at_face = -1, int at_vertex = -1)
      : std::runtime_error(what), face(at_face), vertex(at_vertex) {}

  int face,
      vertex;  ///< where, for readers that know the line; -1 when it is no single face or vertex
};

/// Convex polyhedron, immutable, in its own frame [m]. Built once, shared by all bodies of its
/// shape.
class Polyhedron {
 public:
  /// One undirected edge: its ends and the two faces that meet there. Seen from outside, face
  /// `left` runs tail -> head and face `right` runs head -> tail.
  struct Edge {
    int tail, head;
    int left, right;
  };

  /// `faces`: vertex loops, counter-clockwise seen from outside, any length >= 3 (coplanar polygons
  /// stay polygons). Throws InvalidPolyhedron unless the mesh is closed (each directed edge once,
  /// its reverse once), one piece (Euler), flat-faced, convex, outward, without zero-area faces,
  /// unused or repeated vertices, NaN or infinity. Neighbouring faces may be coplanar, but a face's
  /// corners must be strictly convex: only then does walking uphill along edges always end at the
  /// support vertex. `tolerance`, relative to the size (largest distance of a vertex from the
  /// vertices' mean): how far a vertex may lie off its face's plane or in front of another's, and
  /// below which edges and the heights of faces count as zero. Very thin faces are granted, on top,
  /// what the rounding of coordinates does to their plane.
  Polyhedron(std::vector<Vec3> vertices, const std::vector<std::vector<int>>& faces,
             double tolerance = 1e-9);

  int vertex_count() const { return static_cast<int>(vertices_.size()); }
  int face_count() const { return static_cast<int>(normals_.size()); }
  int edge_count() const { return static_cast<int>(edges_.size()); }

  std::span<const Vec3> vertices() const { return vertices_; }
  const Vec3& vertex(int v) const { return vertices_[v]; }

  /// Vertices of face f, counter-clockwise from outside.
  std::span<const int> face(int f) const {
    return {face_vertices_.data() + face_begin_[f],
            static_cast<size_t>(face_begin_[f + 1] - face_begin_[f])};
  }
  /// Faces across the edges of face f: neighbour k lies across face(f)[k] -> face(f)[k+1].
  std::span<const int> face_neighbours(int f) const {
    return {face_neighbours_.data() + face_begin_[f],
            static_cast<size_t>(face_begin_[f + 1] - face_begin_[f])};
  }
  /// Outward unit normal of face f, and its offset: the solid is {x : normal(f).x <= offset(f) for
  /// all f}.
  const Vec3& normal(int f) const { return normals_[f]; }
  double offset(int f) const { return offsets_[f]; }
  std::span<const Vec3> normals() const { return normals_; }

  std::span<const Edge> edges() const { return edges_; }
  /// Vertices that share an edge with v, ascending.
  std::span<const int> vertex_neighbours(int v) const {
    return {vertex_neighbours_.data() + neighbour_begin_[v],
            static_cast<size_t>(neighbour_begin_[v + 1] - neighbour_begin_[v])};
  }
  /// Faces that meet at v, ascending.
  std::span<const int> vertex_faces(int v) const {
    return {vertex_faces_.data() + vertex_face_begin_[v],
            static_cast<size_t>(vertex_face_begin_[v + 1] - vertex_face_begin_[v])};
  }

  /// Largest distance origin-vertex, and the radius of the largest ball around the origin inside
  /// the solid (negative when the origin lies outside) [m].
  double circumradius() const { return circumradius_; }
  double inradius() const { return inradius_; }

  /// Index of a vertex with the largest d.x (smallest index among equals). O(vertices); the obvious
  /// oracle.
  int support(const Vec3& d) const;

 private:
  void check_input(const std::vector<std::vector<int>>& faces, double tolerance) const;
  void build_faces(const std::vector<std::vector<int>>& faces);
  void build_edges();
  void build_vertex_lists();
  void check_one_piece() const;
  std::vector<double> build_planes(double tolerance);
  void check_face(int f, double tolerance) const;
  void check_convex(double tolerance, const std::vector<double>& thinness) const;

  std::vector<Vec3> vertices_;
  double size_ =
      0.0;  // largest distance of a vertex from the vertices' mean: the scale of the tolerances
  std::vector<int> face_begin_, face_vertices_, face_neighbours_;
  std::vector<Vec3> normals_;
  std::vector<double> offsets_;
  std::vector<Edge> edges_;
  std::vector<int> neighbour_begin_, vertex_neighbours_;
  std::vector<int> vertex_face_begin_, vertex_faces_;
  double circumradius_ = 0.0, inradius_ = 0.0;
};

/// An axis-aligned box with full side lengths `size` [m], centred at the origin.
Polyhedron make_box(const Vec3& size);

}  // namespace ballast
