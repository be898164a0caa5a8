#include "problems/scene/scene_bodies.hpp"

#include <map>
#include <set>

#include "geometry/shape/mesh_file.hpp"
#include "problems/scene/scene_key.hpp"
#include "problems/scene/scene_keys.hpp"

namespace ballast {
namespace {

void check_direction(TomlTable& table, const char* key, const Vec3& v) {
  if (v.norm() == 0.0) table.fail(key, "has no direction, expected a vector that is not zero");
}

WallSpec read_wall(TomlTable& table, const std::string& default_name) {
  WallText given;
  given.name = default_name;
  read_keys(table, wall_keys, given);
  check_direction(table, "normal", given.normal);
  WallSpec wall;
  wall.name = given.name;
  wall.normal = given.normal.normalized();
  // the plane is normal.x = offset with the normal as given in the file, whatever its length
  wall.offset = given.offset / given.normal.norm();
  wall.friction = given.friction;
  if (given.motion == "prescribed") {
    wall.motion = WallMotion::prescribed;
    read_keys(table, prescribed_wall_keys, wall);
  } else if (given.motion == "driven") {
    wall.motion = WallMotion::driven;
    read_keys(table, driven_wall_keys, wall);
    wall.load = read_section(
        table.section("load"), load_keys, [](TomlTable& load_table, const HarmonicLoad& load) {
          if (load.f_min > load.f_max)
            load_table.fail("f_min", "larger than f_max, expected f_min <= f_max");
        });
  }
  table.finish();
  return wall;
}

Quat read_orientation(TomlTable table) {
  const OrientationText given = read_section(
      std::move(table), orientation_keys,
      [](TomlTable& own, const OrientationText& text) { check_direction(own, "axis", text.axis); });
  const double angle = given.angle_degrees * std::numbers::pi / 180.0;
  return Quat(Eigen::AngleAxisd(angle, given.axis.normalized())).normalized();
}

PrincipalShape read_mesh_shape(TomlTable& table, const ShapeText& given,
                               const std::filesystem::path& folder, std::string& key_of_mesh) {
  const std::string path = mesh_path(folder, given.file);
  table.replace_resolved("file", toml::value<std::string>(path));
  try {
    const Polyhedron mesh =
        given.hull ? read_mesh_hull(path, given.scale) : read_mesh(path, given.scale);
    key_of_mesh = mesh_key(mesh);
    return to_principal_frame(mesh);
  } catch (const MeshFileError& error) {
    table.fail("file", error.what());
  }
}

PrincipalShape read_shape(TomlTable& table, const std::string& kind,
                          const std::filesystem::path& folder, std::string& key_of_mesh) {
  ShapeText given;
  read_keys(table, shape_keys(kind), given);
  if (kind == "box" && !(given.size.minCoeff() > 0.0))
    table.fail("size", "out of range, expected three lengths > 0 [m]");
  try {
    if (kind == "box") return to_principal_frame(make_box(given.size));
    if (kind == "mesh") return read_mesh_shape(table, given, folder, key_of_mesh);
    if (kind == "sphere") return to_principal_frame(make_sphere(given.radius, given.subdivisions));
    return make_grain(GrainShapeSettings{}, given.radius, given.seed);
  } catch (const InvalidPolyhedron& error) {  // a box a million times thinner than wide, say
    table.fail("shape", error.what());
  }
}

/// From either `mass` or `density`; a body that cannot move needs neither.
double mass_of(TomlTable& table, BodyText& given, double volume, bool can_move) {
  const bool has_mass = table.has("mass"), has_density = table.has("density");
  if (has_mass && has_density)
    table.fail("mass", "given together with density, expected one of the two");
  if (can_move && !has_mass && !has_density)  // reading it as required says what is missing
    for (const SceneKey<BodyText>& key : body_keys)
      if (key.name == std::string_view("density"))
        table.read(key.name, key.value.rule, true, key.value.in(given));
  return has_mass ? given.mass : volume * given.density;
}

void set_locks(TomlTable& table, const std::vector<std::string>& locked, BodySpec& body) {
  const std::map<std::string, bool BodySpec::*> locks{{"x", &BodySpec::free_x},
                                                      {"y", &BodySpec::free_y},
                                                      {"z", &BodySpec::free_z},
                                                      {"rotation", &BodySpec::free_rotation}};
  for (const std::string& lock : locked) {
    if (!locks.contains(lock))
      table.fail("locked", "unknown word \"" + lock +
                               "\", expected a list of \"x\", \"y\", \"z\", \"rotation\"");
    body.*locks.at(lock) = false;
  }
}

/// A velocity along a locked direction could never change: it would be a motor, which this is not.
void check_locked_velocity(TomlTable& table, const BodySpec& body, const Vec3& spin) {
  const bool free[3] = {body.free_x, body.free_y, body.free_z};
  for (int i = 0; i < 3; ++i)
    if (!free[i] && body.velocity[i] != 0.0)
      table.fail("velocity", "moves along a locked direction, expected 0 there");
  if (!body.free_rotation && spin.norm() != 0.0)
    table.fail("spin", "turns a body of locked rotation, expected 0");
}

BodySpec read_body(TomlTable& table, const std::filesystem::path& folder,
                   const std::string& default_name) {
  BodyText given;
  given.name = default_name;
  read_keys(table, body_keys, given);
  BodySpec body;
  PrincipalShape shape = read_shape(table, given.shape, folder, body.mesh_key);
  body.name = given.name;
  body.shape = std::make_shared<const Polyhedron>(std::move(shape.shape));
  set_locks(table, given.locked, body);
  const bool can_move = body.free_x || body.free_y || body.free_z || body.free_rotation;
  body.mass = mass_of(table, given, shape.volume, can_move);
  // Moments per unit density [m^5] times the density.
  body.inertia = body.mass / shape.volume * shape.inertia;

  // pose of the shape as given, then of its principal frame within it
  const Pose pose{given.position, read_orientation(table.section("orientation"))};
  body.pose.position = pose * shape.pose.position;
  body.pose.rotation = (pose.rotation * shape.pose.rotation).normalized();

  body.velocity = given.velocity;
  // A scene gives spins in the world frame, and states keep them in the body frame.
  body.spin = body.pose.rotation.conjugate() * given.spin;
  check_locked_velocity(table, body, given.spin);
  body.force = read_section(table.section("force"), force_keys);
  table.finish();
  return body;
}

void check_names(TomlTable& table, const std::string& name, std::set<std::string>& names) {
  if (name.empty()) table.fail("name", "empty, expected a name");
  if (!names.insert(name).second) table.fail("name", "given twice, expected a name of its own");
}

}  // namespace

std::string mesh_path(const std::filesystem::path& scene_folder, const std::string& name) {
  return std::filesystem::absolute(scene_folder / name).lexically_normal().string();
}

std::vector<WallSpec> read_walls(TomlTable& root) {
  std::vector<WallSpec> walls;
  std::set<std::string> names;
  std::vector<TomlTable> tables = root.sections("wall");
  for (size_t i = 0; i < tables.size(); ++i) {
    walls.push_back(read_wall(tables[i], "wall_" + std::to_string(i)));
    check_names(tables[i], walls.back().name, names);
  }
  return walls;
}

std::vector<BodySpec> read_bodies(TomlTable& root, const std::filesystem::path& scene_folder,
                                  const std::vector<WallSpec>& walls) {
  std::vector<BodySpec> bodies;
  std::set<std::string> names;
  for (const WallSpec& wall : walls) names.insert(wall.name);
  std::vector<TomlTable> tables = root.sections("body");
  for (size_t i = 0; i < tables.size(); ++i) {
    bodies.push_back(read_body(tables[i], scene_folder, "body_" + std::to_string(i)));
    check_names(tables[i], bodies.back().name, names);
  }
  return bodies;
}

}  // namespace ballast
