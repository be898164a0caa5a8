#pragma once
// The error of a mesh that bounds no convex solid.

#include <stdexcept>
#include <string>

namespace ballast {

/// A mesh that is not a closed convex outward non-degenerate polyhedron; what() names the face,
/// edge or vertex.
class InvalidPolyhedron : public std::runtime_error {
 public:
  explicit InvalidPolyhedron(const std::string& what, int at_face = -1, int at_vertex = -1)
      : std::runtime_error(what), face(at_face), vertex(at_vertex) {}

  /// Where, for readers that know the line; -1 when the defect is no single face or vertex.
  int face, vertex;
};

}  // namespace ballast
