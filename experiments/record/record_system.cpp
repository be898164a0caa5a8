#include "experiments/record/record_system.hpp"

#include <algorithm>

#include "geometry/shape/convex_hull.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"

namespace ballast {
namespace {

/// The polygons of a shape are what its hull makes of the vertices; where that drops one, the
/// stored triangles are taken as they are.
std::shared_ptr<const Polyhedron> shape_of(std::vector<Vec3> vertices,
                                           const std::vector<std::vector<int>>& triangles) {
  try {
    Polyhedron hull = convex_hull(vertices);
    if (hull.vertex_count() == static_cast<int>(vertices.size()))
      return std::make_shared<const Polyhedron>(std::move(hull));
  } catch (const InvalidPolyhedron&) {
  }
  return std::make_shared<const Polyhedron>(std::move(vertices), triangles, 1e-6);
}

std::vector<std::shared_ptr<const Polyhedron>> read_shapes(const Hdf5Reader& file,
                                                           const std::filesystem::path& path) {
  const std::vector<double> vertices = file.read_doubles("shapes/vertices");
  const std::vector<int> triangles = file.read_ints("shapes/triangles"),
                         vertex_begin = file.read_ints("shapes/vertex_begin"),
                         triangle_begin = file.read_ints("shapes/triangle_begin");
  const auto refuse = [&] {
    throw Error(path.string() + ": the datasets of /shapes do not fit together");
  };
  // Where each shape begins: from zero, ascending, to the end of entries that come three by three.
  const auto divides = [](const std::vector<int>& begin, size_t entries) {
    return !begin.empty() && begin.front() == 0 && std::is_sorted(begin.begin(), begin.end()) &&
           3 * static_cast<size_t>(begin.back()) == entries;
  };
  if (vertex_begin.size() != triangle_begin.size() || !divides(vertex_begin, vertices.size()) ||
      !divides(triangle_begin, triangles.size()))
    refuse();
  std::vector<std::shared_ptr<const Polyhedron>> shapes;
  for (size_t k = 0; k + 1 < vertex_begin.size(); ++k) {
    std::vector<Vec3> corners;
    for (int v = vertex_begin[k]; v < vertex_begin[k + 1]; ++v)
      corners.emplace_back(vertices.data() + 3 * static_cast<size_t>(v));
    std::vector<std::vector<int>> faces;
    for (int t = triangle_begin[k]; t < triangle_begin[k + 1]; ++t) {
      const int* corner = triangles.data() + 3 * static_cast<size_t>(t);
      faces.push_back({corner[0], corner[1], corner[2]});
    }
    try {
      shapes.push_back(shape_of(std::move(corners), faces));
    } catch (const InvalidPolyhedron& error) {
      throw Error(path.string() + ": shape " + std::to_string(k) + ": " + error.what());
    }
  }
  return shapes;
}

}  // namespace

MechanicalSystem read_record_system(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::vector<std::string> names = file.read_texts("bodies/name");
  const std::vector<double> mass = file.read_doubles("bodies/mass"),
                            volume = file.read_doubles("bodies/volume"),
                            inertia = file.read_doubles("bodies/inertia"),
                            normal = file.read_doubles("bodies/wall_normal");
  const std::vector<int> shape = file.read_ints("bodies/shape");
  const size_t count = names.size();
  if (mass.size() != count || volume.size() != count || shape.size() != count ||
      inertia.size() != 3 * count || normal.size() != 3 * count)
    throw Error(path.string() + ": the datasets of /bodies do not fit together");
  MechanicalSystem system;
  system.shapes = read_shapes(file, path);
  for (size_t b = 0; b < count; ++b) {
    RigidBody body;
    body.name = names[b];
    body.mass = mass[b];
    body.volume = volume[b];
    body.inertia = Vec3(inertia.data() + 3 * b);
    body.shape.plane.normal = Vec3(normal.data() + 3 * b);
    if (shape[b] >= static_cast<int>(system.shapes.size()))
      throw Error(path.string() + ": bodies/shape[" + std::to_string(b) + "] names no shape");
    if (shape[b] >= 0) {
      body.shape.polyhedron = system.shapes[static_cast<size_t>(shape[b])].get();
      if (static_cast<int>(b) != system.grain_count++)
        throw Error(path.string() + ": /bodies has a wall before a grain");
    }
    system.bodies.push_back(std::move(body));
  }
  return system;
}

}  // namespace ballast
