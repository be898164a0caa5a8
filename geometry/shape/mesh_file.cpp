#include "geometry/shape/mesh_file.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/nearly_convex.hpp"
#include "geometry/shape/obj_format.hpp"
#include "geometry/shape/rounded_hull.hpp"
#include "geometry/shape/stl_format.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {

namespace {

using raw_mesh::Place;
using raw_mesh::RawMesh;

/// Dents and steps up to this part of the size are rounding of the file's numbers (single
/// precision, six digits): 16 roundings of single precision, more where the solid lies far from the
/// origin. Where it lies so far that less than four digits are left, the mesh is broken.
double file_tolerance(const RawMesh& mesh) {
  constexpr double six_digits = 1e-6, single = 6e-8, most = 1e-4;
  if (!mesh.is_single) return six_digits;
  double reach = 0.0, size = 0.0;
  for (const Vec3& p : mesh.vertices) {
    reach = std::max(reach, p.norm());
    size = std::max(size, (p - mesh.vertices[0]).norm());
  }
  const double rounding = size > 0.0 ? single * reach / size : 0.0;
  return std::clamp(16.0 * rounding, six_digits, most);
}

enum class Format { obj, stl };

Format format_of(const std::filesystem::path& file) {
  std::string suffix = file.extension().string();
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (suffix == ".obj") return Format::obj;
  if (suffix == ".stl") return Format::stl;
  Place{file}.fail("unknown suffix '" + suffix + "': .obj and .stl are read");
}

std::string content_of(const std::filesystem::path& file) {
  std::string content;
  try {
    content = read_whole_file(file);
  } catch (const Error& error) {
    throw MeshFileError(error.what());
  }
  if (content.empty()) Place{file}.fail("the file is empty");
  return content;
}

RawMesh read_raw(const std::filesystem::path& file, double scale) {
  if (!(scale > 0.0 && std::isfinite(scale)))
    Place{file}.fail("the scale must be positive and finite");
  const Format format = format_of(file);
  const std::string content = content_of(file);
  RawMesh mesh =
      format == Format::obj ? raw_mesh::read_obj(file, content) : raw_mesh::read_stl(file, content);
  if (mesh.vertices.empty()) Place{file}.fail("the file has no vertices");
  for (Vec3& p : mesh.vertices) p *= scale;
  return mesh;
}

/// The message of `error` with the line of the face or vertex that it is about.
[[noreturn]] void fail_at(const std::filesystem::path& file, const RawMesh& mesh,
                          const InvalidPolyhedron& error) {
  int line = 0;
  std::string counting = " (faces and vertices count from 0)";
  if (error.face >= 0) {
    line = mesh.face_lines[error.face];
  } else if (error.vertex >= 0) {
    line = mesh.vertex_lines[error.vertex];
  } else {
    counting.clear();
  }
  Place{file, line}.fail(error.what() + counting);
}

/// The solid that was meant by a mesh that is convex to `tolerance` only.
Polyhedron rounded_solid(const RawMesh& mesh, double tolerance) {
  const Polyhedron nearly(mesh.vertices, mesh.faces, tolerance,
                          0.5 * tolerance);  // throws when the mesh is really broken
  return rounded_hull(hull_of_nearly_convex(nearly, tolerance), tolerance);
}

/// Whether two neighbouring faces lie in one plane: contact patches want them as one polygon.
bool has_coplanar_neighbours(const Polyhedron& polyhedron) {
  return std::ranges::any_of(polyhedron.edges(), [&](const Polyhedron::Edge& edge) {
    return std::ranges::all_of(polyhedron.face(edge.right), [&](int v) {
      const Vec3 arm = polyhedron.vertex(v) - polyhedron.vertex(edge.tail);
      return std::abs(polyhedron.normal(edge.left).dot(arm)) <= 1e-9 * polyhedron.circumradius();
    });
  });
}

}  // namespace

Polyhedron read_mesh(const std::filesystem::path& file, double scale) {
  const RawMesh mesh = read_raw(file, scale);
  if (mesh.faces.empty()) Place{file}.fail("the file has no faces");
  const double tolerance = file_tolerance(mesh);
  try {
    // Of so many, few in single precision are convex as they stand.
    if (mesh.is_single && mesh.vertices.size() >= many_vertices)
      return rounded_solid(mesh, tolerance);
    try {
      // A mesh that is convex as it stands is taken, but for two kinds: single precision, whose
      // faces are fitted anew, and polygons cut into pieces, which are joined.
      Polyhedron polyhedron(mesh.vertices, mesh.faces);
      if (has_coplanar_neighbours(polyhedron))
        polyhedron = mesh.vertices.size() < many_vertices ? convex_hull(mesh.vertices)
                                                          : convex_hull_of_mesh(polyhedron);
      return mesh.is_single ? rounded_hull(std::move(polyhedron), tolerance) : polyhedron;
    } catch (const InvalidPolyhedron&) {
      return rounded_solid(mesh, tolerance);
    }
  } catch (const InvalidPolyhedron& error) {
    fail_at(file, mesh, error);
  }
}

Polyhedron read_mesh_hull(const std::filesystem::path& file, double scale) {
  const RawMesh mesh = read_raw(file, scale);
  try {
    return mesh.is_single ? rounded_hull(mesh.vertices, file_tolerance(mesh))
                          : convex_hull(mesh.vertices);
  } catch (const InvalidPolyhedron& error) {
    Place{file}.fail(error.what());
  }
}

}  // namespace ballast
