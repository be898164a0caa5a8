#include "problems/scene/scene_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

#include "geometry/shape/mesh_file.hpp"
#include "platform/pack.hpp"
#include "platform/text.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "problems/scene/toml_reader.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using enum Presence;

/// Of every friction coefficient.
constexpr NumberRange friction_range{"a number from 0 to 1e4 (which holds as a bond would)", 0.0,
                                     largest_friction, true, true};
constexpr NumberRange fill_range{"a number > 0 and <= 0.5", 0.0, 0.5, false, true};
constexpr NumberRange axis_ratio{"an axis ratio > 0.1 and <= 1", 0.1, 1.0, false, true};
constexpr NumberRange roughness_range{"a number from 0 to below 0.15", 0.0, 0.15, true, false};

void check_direction(const TomlTable& table, const char* key, const Vec3& v) {
  if (v.norm() == 0.0) table.fail(key, "has no direction, expected a vector that is not zero");
}

/// A mesh file's name made absolute: from the scene's folder, not from where the program runs.
std::string mesh_path(const fs::path& scene_folder, const std::string& name) {
  return fs::absolute(scene_folder / name).lexically_normal().string();
}

// [[wall]] and [[body]].

WallSpec read_wall(TomlTable& table, const std::string& default_name) {
  WallSpec wall;
  std::string motion = "fixed";
  wall.name = default_name;
  table.read("name", &wall.name);
  table.read("normal", &wall.normal, {}, required);
  table.read("offset", &wall.offset, of_unit("m"));
  table.read("friction", &wall.friction, in(friction_range));
  table.read("motion", &motion, one_of({"fixed", "prescribed", "driven"}));
  check_direction(table, "normal", wall.normal);
  // The plane is normal.x = offset with the normal as given in the file, whatever its length.
  wall.offset /= wall.normal.norm();
  wall.normal.normalize();
  if (motion == "prescribed") {
    wall.motion = WallMotion::prescribed;
    table.read("amplitude", &wall.amplitude, of_unit("m"), required);
    table.read("frequency", &wall.frequency, in(not_negative, "Hz"), required);
  } else if (motion == "driven") {
    wall.motion = WallMotion::driven;
    table.read("mass", &wall.mass, in(positive, "kg"), required);
    TomlTable load = table.section("load");
    load.read("f_max", &wall.load.f_max, in(not_negative, "N"), required);
    load.read("f_min", &wall.load.f_min, in(not_negative, "N"));
    load.read("frequency", &wall.load.frequency, in(not_negative, "Hz"), required);
    load.finish();
    if (wall.load.f_min > wall.load.f_max)
      load.fail("f_min", "larger than f_max, expected f_min <= f_max");
  }
  table.finish();
  return wall;
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

PrincipalShape read_mesh_shape(TomlTable& table, const fs::path& folder, std::string& key_of_mesh) {
  std::string file;
  double scale = 1.0;
  bool hull = false;
  table.read("file", &file, {}, required);
  table.read("scale", &scale, in(positive, "m per unit of the file"));
  table.read("hull", &hull);
  const std::string path = mesh_path(folder, file);
  table.replace_resolved("file", toml::value<std::string>(path));
  const Polyhedron mesh = hull ? read_mesh_hull(path, scale) : read_mesh(path, scale);
  key_of_mesh = mesh_key(mesh);
  return to_principal_frame(mesh);
}

/// Each kind of shape has keys of its own.
PrincipalShape read_shape(TomlTable& table, const fs::path& folder, std::string& key_of_mesh) {
  std::string kind;
  Vec3 size = Vec3::Zero();
  double radius = 0.0;
  int subdivisions = 3;
  std::uint64_t seed = 1;
  table.read("shape", &kind, one_of({"box", "sphere", "grain", "mesh"}), required);
  try {
    if (kind == "mesh") return read_mesh_shape(table, folder, key_of_mesh);
    if (kind == "box") {
      table.read("size", &size, of_unit("m"), required);
      if (!(size.minCoeff() > 0.0))
        table.fail("size", "out of range, expected three lengths > 0 [m]");
      return to_principal_frame(make_box(size));
    }
    table.read("radius", &radius, in(positive, "m"), required);
    if (kind == "sphere") {
      table.read("subdivisions", &subdivisions, whole(0, 5));
      return to_principal_frame(make_sphere(radius, subdivisions));
    }
    table.read("seed", &seed);
    return make_grain(GrainShapeSettings{}, radius, seed);
  } catch (const MeshFileError& error) {
    table.fail("file", error.what());
  } catch (const InvalidPolyhedron& error) {  // a box a million times thinner than wide, say
    table.fail("shape", error.what());
  }
}

/// From either `mass` or `density`; a body that cannot move needs neither.
double read_mass(TomlTable& table, double volume, bool can_move) {
  const bool has_mass = table.has("mass"), has_density = table.has("density");
  if (has_mass && has_density)
    table.fail("mass", "given together with density, expected one of the two");
  double mass = 0.0, density = 0.0;
  table.read("mass", &mass, in(positive, "kg"), only_where_given);
  table.read("density", &density, in(positive, "kg/m^3"),
             can_move && !has_mass ? required : only_where_given);
  return has_mass ? mass : volume * density;
}

void read_locks(TomlTable& table, BodySpec& body) {
  std::vector<std::string> locked;
  table.read("locked", &locked);
  constexpr std::array<std::string_view, 4> freedoms{"x", "y", "z", "rotation"};
  for (const std::string& lock : locked) {
    const auto at = std::find(freedoms.begin(), freedoms.end(), lock);
    if (at == freedoms.end())
      table.fail("locked", "unknown word \"" + lock +
                               "\", expected a list of \"x\", \"y\", \"z\", \"rotation\"");
    (lock == "rotation" ? body.free_rotation : body.free[at - freedoms.begin()]) = false;
  }
  // A velocity along a locked direction could never change: it would be a motor, which this is not.
  for (int i = 0; i < 3; ++i)
    if (!body.free[i] && body.velocity[i] != 0.0)
      table.fail("velocity", "moves along a locked direction, expected 0 there");
  if (!body.free_rotation && body.spin.norm() != 0.0)
    table.fail("spin", "turns a body of locked rotation, expected 0");
}

BodySpec read_body(TomlTable& table, const fs::path& folder, const std::string& default_name) {
  BodySpec body;
  body.name = default_name;
  table.read("name", &body.name);
  table.read("position", &body.pose.position, of_unit("m"));
  table.read("velocity", &body.velocity, of_unit("m/s"));
  table.read("spin", &body.spin, of_unit("rad/s"));
  read_locks(table, body);
  PrincipalShape shape = read_shape(table, folder, body.mesh_key);
  body.shape = std::make_shared<const Polyhedron>(std::move(shape.shape));
  const bool can_move = body.free[0] || body.free[1] || body.free[2] || body.free_rotation;
  body.mass = read_mass(table, shape.volume, can_move);
  // Moments per unit density [m^5] times the density.
  body.inertia = body.mass / shape.volume * shape.inertia;

  // pose of the shape as given, then of its principal frame within it
  const Pose pose{body.pose.position, read_orientation(table.section("orientation"))};
  body.pose.position = pose * shape.pose.position;
  body.pose.rotation = (pose.rotation * shape.pose.rotation).normalized();
  // A scene gives spins in the world frame, and states keep them in the body frame.
  body.spin = body.pose.rotation.conjugate() * body.spin;
  TomlTable force = table.section("force");
  force.read("constant", &body.force.constant, of_unit("N"));
  force.read("amplitude", &body.force.amplitude, of_unit("N"));
  force.read("frequency", &body.force.frequency, in(not_negative, "Hz"));
  force.read("phase", &body.force.phase, of_unit("rad"));
  force.finish();
  table.finish();
  return body;
}

/// The walls, then the bodies. Names are unique among both; unnamed ones are called wall_0, body_0,
/// ...
void read_walls_and_bodies(TomlTable& root, const fs::path& folder, Scene& scene) {
  std::set<std::string> names;
  const auto check_name = [&](const TomlTable& table, const std::string& name) {
    if (name.empty()) table.fail("name", "empty, expected a name");
    if (!names.insert(name).second) table.fail("name", "given twice, expected a name of its own");
  };
  for (TomlTable& table : root.sections("wall")) {
    scene.walls.push_back(read_wall(table, "wall_" + std::to_string(scene.walls.size())));
    check_name(table, scene.walls.back().name);
  }
  for (TomlTable& table : root.sections("body")) {
    scene.bodies.push_back(read_body(table, folder, "body_" + std::to_string(scene.bodies.size())));
    check_name(table, scene.bodies.back().name);
  }
}

// Grains in a box.

/// Classes by number; given sizes must have fractions that sum to 1. Without the key: the paper's.
std::vector<SizeClass> read_distribution(TomlTable& grains) {
  if (!grains.has("distribution")) {
    toml::array kept;
    for (const SizeClass& c : paper_size_distribution())
      kept.push_back(toml::table{{"fraction", c.fraction}, {"size", c.size}});
    grains.sections("distribution");  // known
    grains.replace_resolved("distribution", kept);
    return paper_size_distribution();
  }
  std::vector<SizeClass> classes;
  double sum = 0.0;
  for (TomlTable& table : grains.sections("distribution")) {
    SizeClass& one = classes.emplace_back();
    table.read("size", &one.size, in(positive, "m"), required);
    table.read("fraction", &one.fraction, in(part_of_one, "by number"), required);
    table.finish();
    sum += one.fraction;
  }
  if (std::abs(sum - 1.0) > 1e-9)
    grains.fail("distribution",
                "fractions sum to " + toml_value_text(toml::value<double>(sum)) + ", expected 1");
  return classes;
}

void read_grain_shape(TomlTable table, GrainShapeSettings& s) {
  table.read("min_vertices", &s.min_vertices, whole(4, 200));
  table.read("max_vertices", &s.max_vertices, whole(4, 200));
  table.read("elongation_min", &s.elongation_min, in(axis_ratio));
  table.read("elongation_max", &s.elongation_max, in(axis_ratio));
  table.read("flatness_min", &s.flatness_min, in(axis_ratio));
  table.read("flatness_max", &s.flatness_max, in(axis_ratio));
  table.read("roughness", &s.roughness, in(roughness_range));
  table.finish();
  if (s.min_vertices > s.max_vertices)
    table.fail("min_vertices", "larger than max_vertices, expected at most that");
  if (s.elongation_min > s.elongation_max)
    table.fail("elongation_min", "larger than elongation_max");
  if (s.flatness_min > s.flatness_max) table.fail("flatness_min", "larger than flatness_max");
  if (s.flatness_min > s.elongation_min)
    table.fail("flatness_min", "larger than elongation_min, expected at most that");
}

GrainsSpec read_grains(TomlTable table, const fs::path& folder) {
  GrainsSpec grains;
  std::string size = "radius";
  std::vector<std::string> meshes;
  table.read("count", &grains.count, whole(1, 1'000'000), required);
  table.read("seed", &grains.seed);
  table.read("density", &grains.density, in(positive, "kg/m^3"));
  table.read("size", &size, one_of({"radius", "diameter"}));
  table.read("meshes", &meshes);
  grains.size_convention = size == "radius" ? SizeConvention::radius : SizeConvention::diameter;
  grains.distribution = read_distribution(table);
  read_grain_shape(table.section("shape"), grains.shape);
  // files are named in the resolved text by where they are, so that it can be read elsewhere
  toml::array kept;
  for (const std::string& name : meshes) {
    const std::string path = mesh_path(folder, name);
    kept.push_back(path);
    try {
      grains.meshes.push_back(read_mesh_hull(path));
    } catch (const MeshFileError& error) {
      table.fail("meshes", error.what());
    }
  }
  table.replace_resolved("meshes", kept);
  table.finish();
  return grains;
}

void read_box(TomlTable table, BoxSpec& s, const GrainsSpec& grains) {
  table.read("length", &s.length, in(positive, "m"), required);
  table.read("width", &s.width, in(positive, "m"), required);
  table.read("friction_horizontal", &s.friction_horizontal, in(friction_range));
  table.read("friction_vertical", &s.friction_vertical, in(friction_range));
  table.finish();
  // A box that no grain fits through cannot be filled.
  double widest = 0.0;
  for (const SizeClass& c : grains.distribution)
    widest =
        std::max(widest, grains.size_convention == SizeConvention::radius ? 2.0 * c.size : c.size);
  const std::string expected = "narrower than the largest grain, expected at least " +
                               toml_value_text(toml::value<double>(widest)) + " [m]";
  if (s.length < widest) table.fail("length", expected);
  if (s.width < widest) table.fail("width", expected);
}

void read_deposit(TomlTable table, DepositSpec& s) {
  table.read("step", &s.step, in(positive, "s"));
  table.read("friction", &s.friction, in(friction_range));
  table.read("fill_fraction", &s.fill_fraction, in(fill_range, "of the bounding spheres"));
  table.read("max_time", &s.max_time, in(positive, "s"));
  table.read("rest_velocity", &s.rest_velocity, in(positive, "m/s"));
  table.read("lid_pressure_weight", &s.lid_pressure_weight, in(not_negative, "grain weights"));
  table.read("lid_time", &s.lid_time, in(not_negative, "s"));
  table.read("settle_time", &s.settle_time, in(not_negative, "s"));
  table.read("settle_step", &s.settle_step, in(positive, "s"));
  table.read("gravity", &s.gravity, in(not_negative, "m/s^2"));
  table.read("solver", &s.solver);
  table.read("tolerance", &s.tolerance, in(not_negative, "g h"));
  table.read("max_iterations", &s.max_iterations, whole(1));
  table.finish();
  // as for the scene: steps are counted
  const std::tuple<const char*, double, double> stages[] = {
      {"max_time", s.max_time, s.step},
      {"lid_time", s.lid_time, s.step},
      {"settle_time", s.settle_time, s.settle_step}};
  for (const auto& [key, time, step] : stages)
    if (time / step > 1e12) table.fail(key, "too long, expected at most 1e12 steps");
  if (s.max_time < s.step)
    table.fail("max_time", "shorter than a step, expected at least deposit.step");
}

void read_drive(TomlTable table, DriveSpec& s) {
  table.read("frequency", &s.frequency, in(positive, "Hz"));
  table.read("f_max_over_weight", &s.f_max_over_weight, in(not_negative, "grain weights"));
  table.read("f_min_over_weight", &s.f_min_over_weight, in(not_negative, "grain weights"));
  table.read("wall_mass_over_grains", &s.wall_mass_over_grains, in(positive, "grain masses"));
  table.read("lid_raise", &s.lid_raise, in(not_negative, "m"));
  table.read("start_noise", &s.start_noise, in(not_negative, "m"), only_where_given);
  table.read("start_noise_seed", &s.start_noise_seed, {}, only_where_given);
  table.finish();
  if (s.f_min_over_weight > s.f_max_over_weight)
    table.fail("f_min_over_weight", "larger than f_max_over_weight, expected at most that");
}

void read_control_volume(TomlTable table, ControlVolumeSpec& s, const BoxSpec& box) {
  table.read("margin_x", &s.margin_x, in(not_negative, "m"));
  table.read("margin_y", &s.margin_y, in(not_negative, "m"));
  table.read("margin_floor", &s.margin_floor, in(not_negative, "m"));
  table.read("margin_top", &s.margin_top, in(not_negative, "m"));
  table.finish();
  if (2.0 * s.margin_x >= box.length)
    table.fail("margin_x", "leaves nothing, expected less than half of box.length");
  if (2.0 * s.margin_y >= box.width)
    table.fail("margin_y", "leaves nothing, expected less than half of box.width");
}

// Both kinds of scenes.

/// A file may have blanks and umlauts in its name, a scene may not.
std::string name_of_file(const fs::path& file) {
  std::string name = file.stem().string();
  for (char& c : name)
    if (!is_plain(std::string_view(&c, 1), "_-.")) c = '_';
  if (name.empty() || name[0] == '.') name.insert(0, 1, '_');
  return name;
}

void read_head(TomlTable table, Scene& scene, const fs::path& file) {
  scene.name = name_of_file(file);
  table.read("name", &scene.name);
  table.read("title", &scene.title);
  table.read("step", &scene.step, in(positive, "s"));
  table.read("duration", &scene.duration, in(positive, "s"));
  // a name is also a folder's name
  if (!is_plain(scene.name, "_-.") || scene.name[0] == '.')
    table.fail("name", "expected letters, digits, _, - and .");
  if (scene.step > scene.duration)
    table.fail("step", "longer than the scene, expected step <= duration");
  if (scene.duration / scene.step > 1e12)
    table.fail("step", "too short, expected at most 1e12 steps");
  table.finish();
}

Vec3 read_gravity(TomlTable table) {
  double magnitude = 9.81;
  Vec3 direction(0, 0, -1);
  table.read("magnitude", &magnitude, in(not_negative, "m/s^2"));
  table.read("direction", &direction);
  table.finish();
  check_direction(table, "direction", direction);
  return magnitude * direction.normalized();
}

void read_solver(TomlTable table, SolverSpec& s) {
  table.read("name", &s.name);
  table.read("tolerance", &s.tolerance, in(not_negative, "g h"));
  table.read("max_iterations", &s.max_iterations, whole(1));
  table.read("max_seconds", &s.max_seconds, in(positive, "s"));
  table.read("warm_start", &s.warm_start);
  const ValueRule change = in(part_of_one, "relative");
  table.read("change_tolerance", &s.change_tolerance, change, only_where_given);
  table.read("change_every", &s.change_every, whole(1), only_where_given);
  table.finish();
}

void read_record(TomlTable table, RecordSpec& s) {
  table.read("pose_rate", &s.pose_rate, in(positive, "1/s"));
  table.read("state_rate", &s.state_rate, in(not_negative, "1/s"));
  table.read("checkpoint_seconds", &s.checkpoint_seconds, in(positive, "s"));
  table.read("forces", &s.forces, {}, only_where_given);
  table.finish();
}

/// The vibrated box: everything is made from the grains and the box.
void read_box_scene(TomlTable& root, Scene& scene, const fs::path& folder) {
  for (const char* key : {"body", "wall"})
    if (root.has(key))
      root.fail(key, "given together with [grains], which make their own bodies and walls");
  if (scene.gravity.z() >= 0.0 || scene.gravity.x() != 0.0 || scene.gravity.y() != 0.0)
    root.fail("gravity",
              "grains are deposited along -z, expected magnitude > 0 and direction [0, 0, -1]");
  scene.grains = read_grains(root.section("grains"), folder);
  read_box(root.section("box"), scene.box, *scene.grains);
  read_deposit(root.section("deposit"), scene.deposit);
  read_drive(root.section("drive"), scene.drive);
  read_control_volume(root.section("control_volume"), scene.control_volume, scene.box);
}

void read_body_scene(TomlTable& root, Scene& scene, const fs::path& file) {
  for (const char* key : {"box", "deposit", "drive", "control_volume"})
    if (root.has(key)) root.fail(key, "has no meaning without [grains]");
  read_walls_and_bodies(root, file.parent_path(), scene);
  if (scene.walls.empty() && scene.bodies.empty())
    throw SceneFileError(
        file.string() +
        ": nothing in it, expected [grains] with [box], or at least one [[body]] or [[wall]]");
}

Scene read(TomlTable& root, const fs::path& file) {
  for (const char* key : {"scene", "gravity", "contact", "body", "wall", "grains", "box", "deposit",
                          "drive", "solver", "correction", "detection", "record", "control_volume"})
    root.know(key);
  root.finish();  // a misspelt section first: what follows depends on which sections there are
  // grains decide the kind of scene: a box to be filled, or single bodies and walls
  Scene scene;
  read_head(root.section("scene"), scene, file);
  scene.gravity = read_gravity(root.section("gravity"));
  TomlTable contact = root.section("contact");
  contact.read("friction", &scene.friction, in(friction_range));
  contact.read("restitution", &scene.restitution, in(zero_to_one));
  contact.finish();
  if (root.has("grains")) {
    read_box_scene(root, scene, file.parent_path());
  } else {
    read_body_scene(root, scene, file);
    scene.solver = SolverSpec::for_any_scene();
  }
  read_solver(root.section("solver"), scene.solver);
  TomlTable correction = root.section("correction");
  correction.read("enabled", &scene.correction.enabled);
  correction.read("slop", &scene.correction.slop, in(not_negative, "m"));
  correction.read("fraction", &scene.correction.fraction, in(part_of_one));
  correction.read("sweeps", &scene.correction.sweeps, whole(1));
  correction.finish();
  TomlTable detection = root.section("detection");
  detection.read("max_points", &scene.detection.max_points, whole(1));
  detection.read("skin", &scene.detection.skin, in(not_negative, "m"));
  detection.read("use_cache", &scene.detection.use_cache);
  detection.finish();
  read_record(root.section("record"), scene.record);
  return scene;
}

}  // namespace

ResolvedScene resolve_scene(const fs::path& file, std::span<const std::string> overrides) {
  const toml::table given = load_toml(file, overrides);
  toml::table kept;
  TomlTable root(file.string(), given, kept);
  ResolvedScene resolved{read(root, file), toml_text(kept), ""};
  // The text names meshes by their files. Their contents belong to the key, too: a mesh that is
  // edited makes another scene.
  std::string all = resolved.text;
  for (const BodySpec& body : resolved.scene.bodies)
    if (!body.mesh_key.empty()) all += "mesh " + body.mesh_key + '\n';
  if (resolved.scene.grains)
    for (const Polyhedron& mesh : resolved.scene.grains->meshes)
      all += "mesh " + mesh_key(mesh) + '\n';
  resolved.key = content_key(all);
  return resolved;
}

Scene read_scene(const fs::path& file, std::span<const std::string> overrides) {
  return resolve_scene(file, overrides).scene;
}

std::string mesh_key(const Polyhedron& mesh) {
  Packer packer;
  packer.list(mesh.vertices(), [&](const Vec3& vertex) { packer.fixed(vertex); });
  for (int f = 0; f < mesh.face_count(); ++f) packer.list(mesh.face(f));
  return content_key(packer.bytes());
}

}  // namespace ballast
