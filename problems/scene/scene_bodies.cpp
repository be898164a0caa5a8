#include "problems/scene/scene_bodies.hpp"

#include <algorithm>
#include <set>

#include "geometry/shape/mesh_file.hpp"

namespace ballast {
namespace {

constexpr std::int64_t any_seed = std::numeric_limits<std::int64_t>::max();

/// A direction: any length but zero.
Vec3 direction(TomlTable& table, const char* key, const Vec3& fallback) {
  const Vec3 v = table.vector(key, "", fallback);
  if (v.norm() == 0.0) table.fail(key, "has no direction, expected a vector that is not zero");
  return v.normalized();
}

HarmonicLoad read_load(TomlTable& wall) {
  TomlTable table = wall.section("load");
  HarmonicLoad load;
  load.f_max = table.number("f_max", not_negative, "N");
  load.f_min = table.number("f_min", not_negative, "N", 0.0);
  load.frequency = table.number("frequency", not_negative, "Hz");
  if (load.f_min > load.f_max) table.fail("f_min", "larger than f_max, expected f_min <= f_max");
  table.finish();
  return load;
}

WallSpec read_wall(TomlTable& table, const std::string& default_name) {
  WallSpec wall;
  wall.name = table.text("name", default_name);
  const Vec3 given = table.vector("normal", "");
  wall.normal = direction(table, "normal", given);
  // the plane is normal.x = offset with the normal as given in the file, whatever its length
  wall.offset = table.number("offset", any_number, "m", 0.0) / given.norm();
  wall.friction = table.number("friction", not_negative, "", 0.0);
  const std::string motion = table.choice("motion", {"fixed", "prescribed", "driven"}, "fixed");
  if (motion == "prescribed") {
    wall.motion = WallMotion::prescribed;
    wall.amplitude = table.vector("amplitude", "m");
    wall.frequency = table.number("frequency", not_negative, "Hz");
  } else if (motion == "driven") {
    wall.motion = WallMotion::driven;
    wall.mass = table.number("mass", positive, "kg");
    wall.load = read_load(table);
  }
  table.finish();
  return wall;
}

ForceSpec read_force(TomlTable& body) {
  TomlTable table = body.section("force");
  ForceSpec force;
  force.constant = table.vector("constant", "N", Vec3::Zero());
  force.amplitude = table.vector("amplitude", "N", Vec3::Zero());
  force.frequency = table.number("frequency", not_negative, "Hz", 0.0);
  force.phase = table.number("phase", any_number, "rad", 0.0);
  table.finish();
  return force;
}

Quat read_orientation(TomlTable& body) {
  TomlTable table = body.section("orientation");
  const Vec3 axis = direction(table, "axis", Vec3::UnitZ());
  const double degrees = table.number("angle_degrees", any_number, "degrees", 0.0);
  table.finish();
  return Quat(Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, axis)).normalized();
}

PrincipalShape read_mesh_shape(TomlTable& table, const std::filesystem::path& folder) {
  const std::string path = mesh_path(folder, table.text("file"));
  const double scale = table.number("scale", positive, "m per unit of the file", 1.0);
  const bool hull = table.flag("hull", false);
  table.replace_resolved("file", toml::value<std::string>(path));
  try {
    return to_principal_frame(hull ? read_mesh_hull(path, scale) : read_mesh(path, scale));
  } catch (const MeshFileError& error) {
    table.fail("file", error.what());
  }
}

PrincipalShape read_shape_of_kind(TomlTable& table, const std::string& kind,
                                  const std::filesystem::path& folder) {
  if (kind == "box") {
    const Vec3 size = table.vector("size", "m");
    if (!(size.minCoeff() > 0.0))
      table.fail("size", "out of range, expected three lengths > 0 [m]");
    return to_principal_frame(make_box(size));
  }
  if (kind == "mesh") return read_mesh_shape(table, folder);
  const double radius = table.number("radius", positive, "m");
  if (kind == "sphere") {
    const auto subdivisions = static_cast<int>(table.whole("subdivisions", 0, 6, 3));
    return to_principal_frame(make_sphere(radius, subdivisions));
  }
  return make_grain(GrainShapeSettings{}, radius,
                    static_cast<std::uint64_t>(table.whole("seed", 0, any_seed, 1)));
}

PrincipalShape read_shape(TomlTable& table, const std::filesystem::path& folder) {
  const std::string kind = table.choice("shape", {"box", "sphere", "grain", "mesh"});
  try {
    return read_shape_of_kind(table, kind, folder);
  } catch (const InvalidPolyhedron& error) {  // a box a million times thinner than wide, say
    table.fail("shape", error.what());
  }
}

/// Either `mass` or `density`; a body that cannot move needs neither.
double read_mass(TomlTable& table, double volume, bool can_move) {
  if (table.has("mass") && table.has("density"))
    table.fail("mass", "given together with density, expected one of the two");
  if (table.has("mass")) return table.number("mass", positive, "kg");
  if (!can_move && !table.has("density")) return 0.0;
  return volume * table.number("density", positive, "kg/m^3");
}

void read_locks(TomlTable& table, BodySpec& body) {
  for (const std::string& lock : table.texts("locked")) {
    if (lock == "x")
      body.free_x = false;
    else if (lock == "y")
      body.free_y = false;
    else if (lock == "z")
      body.free_z = false;
    else if (lock == "rotation")
      body.free_rotation = false;
    else
      table.fail("locked", "unknown word \"" + lock +
                               "\", expected a list of \"x\", \"y\", \"z\", \"rotation\"");
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
  BodySpec body;
  body.name = table.text("name", default_name);
  PrincipalShape shape = read_shape(table, folder);
  body.shape = std::make_shared<const Polyhedron>(std::move(shape.shape));
  read_locks(table, body);
  const bool can_move = body.free_x || body.free_y || body.free_z || body.free_rotation;
  body.mass = read_mass(table, shape.volume, can_move);
  body.inertia = body.mass / shape.volume * shape.inertia;

  // pose of the shape as given, then of its principal frame within it
  const Pose given{table.vector("position", "m", Vec3::Zero()), read_orientation(table)};
  body.pose.position = given * shape.pose.position;
  body.pose.rotation = (given.rotation * shape.pose.rotation).normalized();

  body.velocity = table.vector("velocity", "m/s", Vec3::Zero());
  const Vec3 spin_W = table.vector("spin", "rad/s", Vec3::Zero());
  body.spin = body.pose.rotation.conjugate() * spin_W;
  check_locked_velocity(table, body, spin_W);
  body.force = read_force(table);
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
