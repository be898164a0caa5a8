// Reads the shapes of bodies: the keys of [[body]] and of its parts.

#include <cmath>
#include <numbers>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_bodies.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using enum Presence;

ReadShape of_one(PrincipalShape&& solid) {
  auto hull = std::make_shared<const Polyhedron>(std::move(solid.shape));
  return {{std::move(hull), {}, solid.volume, solid.inertia, solid.pose}, false, ""};
}

ReadShape of_parts(std::span<const PlacedShape> parts) {
  if (parts.size() == 1 && parts[0].pose.position.isZero(0.0) &&
      parts[0].pose.rotation.isApprox(Quat::Identity()))
    return of_one(to_principal_frame(*parts[0].shape));
  return {make_compound(parts), false, ""};
}

/// Reads the name of a mesh file and makes it absolute, in the resolved scene too.
std::string read_mesh_name(TomlTable& table, const fs::path& folder) {
  const std::string file = table.text("file");
  if (file.empty()) table.fail("file", "is empty, expected the path of a mesh");
  const std::string path = mesh_path(folder, file);
  table.replace_resolved("file", toml::value<std::string>(path));
  return path;
}

ReadShape read_mesh_shape(TomlTable& table, const fs::path& folder) {
  double scale = 1.0;
  bool hull = false;
  const std::string path = read_mesh_name(table, folder);
  table.read("scale", &scale, in(positive, "m per unit of the file"));
  table.read("hull", &hull);
  const Polyhedron mesh = hull ? read_mesh_hull(path, scale) : read_mesh(path, scale);
  ReadShape shape = of_one(to_principal_frame(mesh));
  shape.mesh_key = mesh_key(mesh);
  return shape;
}

/// Makes each face of the mesh a part, with a layer behind it.
ReadShape read_surface(TomlTable& table, const fs::path& folder) {
  double scale = 1.0, thickness = 0.0;
  const std::string path = read_mesh_name(table, folder);
  table.read("scale", &scale, in(positive, "m per unit of the file"));
  table.read("thickness", &thickness, in(positive, "m"), required);
  std::vector<PlacedShape> parts;
  std::string keys;
  for (const std::vector<Vec3>& corners : read_faces(path, scale)) try {
      parts.push_back({std::make_shared<const Polyhedron>(thick_polygon(corners, thickness)), {}});
      keys += mesh_key(*parts.back().shape);
    } catch (const InvalidPolyhedron& error) {
      table.fail("file", "face " + std::to_string(parts.size()) + " of " + path + ": " +
                             error.what() + " (faces count from 0)");
    }
  ReadShape shape = of_parts(parts);
  shape.is_surface = true;
  shape.mesh_key = content_key(keys);
  return shape;
}

Polyhedron read_hull(TomlTable& table) {
  NumberRows rows;
  table.read("points", &rows, rows_of(3, "m"), required);
  std::vector<Vec3> points;
  for (const std::vector<double>& row : rows) points.emplace_back(row.data());
  return convex_hull(points);
}

Polyhedron read_box(TomlTable& table) {
  Vec3 size = Vec3::Zero();
  table.read("size", &size, of_unit("m"), required);
  if (!(size.minCoeff() > 0.0)) table.fail("size", "out of range, expected three lengths > 0 [m]");
  return make_box(size);
}

ReadShape read_kind(TomlTable& table, const fs::path& folder, const std::string& kind) {
  if (kind == "mesh") return read_mesh_shape(table, folder);
  if (kind == "surface") return read_surface(table, folder);
  if (kind == "hull") return of_one(to_principal_frame(read_hull(table)));
  if (kind == "box") return of_one(to_principal_frame(read_box(table)));
  double radius = 0.0;
  table.read("radius", &radius, in(positive, "m"), required);
  if (kind == "sphere") {
    int subdivisions = 3;
    table.read("subdivisions", &subdivisions, whole(0, 5));
    return of_one(to_principal_frame(make_sphere(radius, subdivisions)));
  }
  std::uint64_t seed = 1;
  table.read("seed", &seed);
  return of_one(make_grain(GrainShapeSettings{}, radius, seed));
}

ReadShape read_parts(TomlTable& table, const fs::path& folder) {
  if (table.has("shape")) table.fail("part", "given together with shape, expected one of the two");
  std::vector<PlacedShape> placed;
  std::string keys;
  for (TomlTable& part : table.sections("part")) {
    Pose pose;
    part.read("position", &pose.position, of_unit("m"));
    pose.rotation = read_orientation(part.section("orientation"));
    const ReadShape shape = read_shape(part, folder);
    if (!shape.parts.empty()) part.fail("shape", "has parts of its own");
    part.finish();
    placed.push_back({shape.hull, composed(pose, shape.pose)});
    keys += shape.mesh_key;
  }
  if (placed.empty()) table.fail("part", "empty, expected at least one [[body.part]]");
  ReadShape shape = of_parts(placed);
  if (!keys.empty()) shape.mesh_key = content_key(keys);
  return shape;
}

}  // namespace

ReadShape read_shape(TomlTable& table, const fs::path& folder) {
  table.know("part");
  try {
    if (table.has("part")) return read_parts(table, folder);
    std::string kind;
    table.read("shape", &kind, one_of({"box", "sphere", "grain", "mesh", "hull", "surface"}),
               required);
    return read_kind(table, folder, kind);
  } catch (const MeshFileError& error) {
    table.fail("file", error.what());
  } catch (const InvalidPolyhedron& error) {  // e.g. a box a million times thinner than wide
    table.fail("shape", error.what());
  }
}

Quat read_orientation(TomlTable table) {
  Vec3 axis = Vec3::UnitZ();
  double degrees = 0.0;
  table.read("axis", &axis);
  table.read("angle_degrees", &degrees, of_unit("degrees"));
  table.finish();
  check_direction(table, "axis", axis);
  const double angle = degrees * std::numbers::pi / 180.0;
  return Quat(Eigen::AngleAxisd(angle, axis.normalized())).normalized();
}

std::string mesh_path(const fs::path& scene_folder, const std::string& name) {
  return fs::absolute(scene_folder / name).lexically_normal().string();
}

void check_direction(const TomlTable& table, const char* key, const Vec3& v) {
  if (v.norm() > 0.0 && std::isfinite(v.norm())) return;
  table.fail(key, "has no direction, expected a vector that is not zero and has a finite length");
}

}  // namespace ballast
