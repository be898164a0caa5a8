#include "problems/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <tuple>

#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/pack.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_keys.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// A table whose keys are all in one list; for what its keys must be to each other.
TomlTable read_section(TomlTable table, const SceneKeys& keys) {
  read_keys(table, keys);
  table.finish();
  return table;
}

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
  read_keys(table, wall_keys(wall, motion));
  check_direction(table, "normal", wall.normal);
  // The plane is normal.x = offset with the normal as given in the file, whatever its length.
  wall.offset /= wall.normal.norm();
  wall.normal.normalize();
  if (motion == "prescribed") {
    wall.motion = WallMotion::prescribed;
    read_keys(table, prescribed_wall_keys(wall));
  } else if (motion == "driven") {
    wall.motion = WallMotion::driven;
    read_keys(table, driven_wall_keys(wall));
    const TomlTable load = read_section(table.section("load"), load_keys(wall.load));
    if (wall.load.f_min > wall.load.f_max)
      load.fail("f_min", "larger than f_max, expected f_min <= f_max");
  }
  table.finish();
  return wall;
}

Quat read_orientation(TomlTable section) {
  OrientationText given;
  const TomlTable table = read_section(std::move(section), orientation_keys(given));
  check_direction(table, "axis", given.axis);
  const double angle = given.angle_degrees * std::numbers::pi / 180.0;
  return Quat(Eigen::AngleAxisd(angle, given.axis.normalized())).normalized();
}

PrincipalShape read_shape(TomlTable& table, ShapeText& given, const fs::path& folder,
                          std::string& key_of_mesh) {
  const std::string& kind = given.kind;
  read_keys(table, shape_keys(kind, given));
  if (kind == "box" && !(given.size.minCoeff() > 0.0))
    table.fail("size", "out of range, expected three lengths > 0 [m]");
  try {
    if (kind == "box") return to_principal_frame(make_box(given.size));
    if (kind == "sphere") return to_principal_frame(make_sphere(given.radius, given.subdivisions));
    if (kind == "grain") return make_grain(GrainShapeSettings{}, given.radius, given.seed);
    const std::string path = mesh_path(folder, given.file);
    table.replace_resolved("file", toml::value<std::string>(path));
    const Polyhedron mesh =
        given.hull ? read_mesh_hull(path, given.scale) : read_mesh(path, given.scale);
    key_of_mesh = mesh_key(mesh);
    return to_principal_frame(mesh);
  } catch (const MeshFileError& error) {
    table.fail("file", error.what());
  } catch (const InvalidPolyhedron& error) {  // a box a million times thinner than wide, say
    table.fail("shape", error.what());
  }
}

/// From either `mass` or `density`; a body that cannot move needs neither.
double mass_of(TomlTable& table, BodySpec& body, ShapeText& given, double volume, bool can_move) {
  const bool has_mass = table.has("mass"), has_density = table.has("density");
  if (has_mass && has_density)
    table.fail("mass", "given together with density, expected one of the two");
  if (can_move && !has_mass && !has_density)  // reading it as required says what is missing
    for (const SceneKey& key : body_keys(body, given))
      if (key.name == std::string_view("density")) table.read(key.name, key.rule, true, key.place);
  return has_mass ? body.mass : volume * given.density;
}

void set_locks(const TomlTable& table, const std::vector<std::string>& locked, BodySpec& body) {
  for (const std::string& lock : locked)
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
  // A velocity along a locked direction could never change: it would be a motor, which this is not.
  const bool free[3] = {body.free_x, body.free_y, body.free_z};
  for (int i = 0; i < 3; ++i)
    if (!free[i] && body.velocity[i] != 0.0)
      table.fail("velocity", "moves along a locked direction, expected 0 there");
  if (!body.free_rotation && body.spin.norm() != 0.0)
    table.fail("spin", "turns a body of locked rotation, expected 0");
}

BodySpec read_body(TomlTable& table, const fs::path& folder, const std::string& default_name) {
  BodySpec body;
  ShapeText given;
  body.name = default_name;
  read_keys(table, body_keys(body, given));
  PrincipalShape shape = read_shape(table, given, folder, body.mesh_key);
  body.shape = std::make_shared<const Polyhedron>(std::move(shape.shape));
  set_locks(table, given.locked, body);
  const bool can_move = body.free_x || body.free_y || body.free_z || body.free_rotation;
  body.mass = mass_of(table, body, given, shape.volume, can_move);
  // Moments per unit density [m^5] times the density.
  body.inertia = body.mass / shape.volume * shape.inertia;

  // pose of the shape as given, then of its principal frame within it
  const Pose pose{body.pose.position, read_orientation(table.section("orientation"))};
  body.pose.position = pose * shape.pose.position;
  body.pose.rotation = (pose.rotation * shape.pose.rotation).normalized();
  // A scene gives spins in the world frame, and states keep them in the body frame.
  body.spin = body.pose.rotation.conjugate() * body.spin;
  read_section(table.section("force"), force_keys(body.force));
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

// All the rest.

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
  read_keys(table, head_keys(scene));
  // a name is also a folder's name
  if (!is_plain(scene.name, "_-.") || scene.name[0] == '.')
    table.fail("name", "expected letters, digits, _, - and .");
  if (scene.step > scene.duration)
    table.fail("step", "longer than the scene, expected step <= duration");
  if (scene.duration / scene.step > 1e12)
    table.fail("step", "too short, expected at most 1e12 steps");
  table.finish();
}

Vec3 read_gravity(TomlTable section) {
  GravityText given;
  const TomlTable table = read_section(std::move(section), gravity_keys(given));
  check_direction(table, "direction", given.direction);
  return given.magnitude * given.direction.normalized();
}

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
    read_section(std::move(table), distribution_keys(classes.emplace_back()));
    sum += classes.back().fraction;
  }
  if (std::abs(sum - 1.0) > 1e-9)
    grains.fail("distribution",
                "fractions sum to " + toml_value_text(toml::value<double>(sum)) + ", expected 1");
  return classes;
}

void check_grain_shape(const TomlTable& table, const GrainShapeSettings& shape) {
  if (shape.min_vertices > shape.max_vertices)
    table.fail("min_vertices", "larger than max_vertices, expected at most that");
  if (shape.elongation_min > shape.elongation_max)
    table.fail("elongation_min", "larger than elongation_max");
  if (shape.flatness_min > shape.flatness_max)
    table.fail("flatness_min", "larger than flatness_max");
  if (shape.flatness_min > shape.elongation_min)
    table.fail("flatness_min", "larger than elongation_min, expected at most that");
}

GrainsSpec read_grains(TomlTable table, const fs::path& folder) {
  GrainsSpec grains;
  GrainsText given;
  read_keys(table, grains_keys(grains, given));
  grains.size_convention =
      given.size == "radius" ? SizeConvention::radius : SizeConvention::diameter;
  grains.distribution = read_distribution(table);
  check_grain_shape(read_section(table.section("shape"), grain_shape_keys(grains.shape)),
                    grains.shape);
  // files are named in the resolved text by where they are, so that it can be read elsewhere
  toml::array kept;
  for (const std::string& name : given.meshes) {
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

/// A box that no grain fits through cannot be filled.
void check_box(const TomlTable& table, const BoxSpec& box, const GrainsSpec& grains) {
  double widest = 0.0;
  for (const SizeClass& c : grains.distribution)
    widest =
        std::max(widest, grains.size_convention == SizeConvention::radius ? 2.0 * c.size : c.size);
  const std::string expected = "narrower than the largest grain, expected at least " +
                               toml_value_text(toml::value<double>(widest)) + " [m]";
  if (box.length < widest) table.fail("length", expected);
  if (box.width < widest) table.fail("width", expected);
}

void check_deposit(const TomlTable& table, const DepositSpec& deposit) {
  // as for the scene: steps are counted
  const std::tuple<const char*, double, double> stages[] = {
      {"max_time", deposit.max_time, deposit.step},
      {"lid_time", deposit.lid_time, deposit.step},
      {"settle_time", deposit.settle_time, deposit.settle_step}};
  for (const auto& [key, time, step] : stages)
    if (time / step > 1e12) table.fail(key, "too long, expected at most 1e12 steps");
  if (deposit.max_time < deposit.step)
    table.fail("max_time", "shorter than a step, expected at least deposit.step");
}

void check_volume(const TomlTable& table, const ControlVolumeSpec& volume, const BoxSpec& box) {
  if (2.0 * volume.margin_x >= box.length)
    table.fail("margin_x", "leaves nothing, expected less than half of box.length");
  if (2.0 * volume.margin_y >= box.width)
    table.fail("margin_y", "leaves nothing, expected less than half of box.width");
}

void read_numerics(TomlTable& root, Scene& scene) {
  if (!root.has("grains")) scene.solver = SolverSpec::for_any_scene();
  read_section(root.section("solver"), solver_keys(scene.solver));
  read_section(root.section("correction"), correction_keys(scene.correction));
  read_section(root.section("detection"), detection_keys(scene.detection));
  read_section(root.section("record"), record_keys(scene.record));
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
  check_box(read_section(root.section("box"), box_keys(scene.box)), scene.box, *scene.grains);
  check_deposit(read_section(root.section("deposit"), deposit_keys(scene.deposit)), scene.deposit);
  const TomlTable drive = read_section(root.section("drive"), drive_keys(scene.drive));
  if (scene.drive.f_min_over_weight > scene.drive.f_max_over_weight)
    drive.fail("f_min_over_weight", "larger than f_max_over_weight, expected at most that");
  ControlVolumeSpec& volume = scene.control_volume;
  check_volume(read_section(root.section("control_volume"), control_volume_keys(volume)), volume,
               scene.box);
}

void read_body_scene(TomlTable& root, Scene& scene, const fs::path& folder,
                     const std::string& file) {
  for (const char* key : {"box", "deposit", "drive", "control_volume"})
    if (root.has(key)) root.fail(key, "has no meaning without [grains]");
  read_walls_and_bodies(root, folder, scene);
  if (scene.walls.empty() && scene.bodies.empty())
    throw SceneFileError(
        file +
        ": nothing in it, expected [grains] with [box], or at least one [[body]] or [[wall]]");
}

Scene read(const fs::path& file, std::span<const std::string> overrides, toml::table& resolved) {
  const toml::table table = load_toml(file, overrides);
  TomlTable root(file.string(), table, resolved);
  for (const char* key : {"scene", "gravity", "contact", "body", "wall", "grains", "box", "deposit",
                          "drive", "solver", "correction", "detection", "record", "control_volume"})
    root.know(key);
  root.finish();  // a misspelt section first: what follows depends on which sections there are
  // grains decide the kind of scene: a box to be filled, or single bodies and walls
  Scene scene;
  read_head(root.section("scene"), scene, file);
  scene.gravity = read_gravity(root.section("gravity"));
  read_section(root.section("contact"), contact_keys(scene));
  if (root.has("grains"))
    read_box_scene(root, scene, file.parent_path());
  else
    read_body_scene(root, scene, file.parent_path(), file.string());
  read_numerics(root, scene);
  return scene;
}

}  // namespace

Scene read_scene(const fs::path& file, std::span<const std::string> overrides) {
  toml::table resolved;
  return read(file, overrides, resolved);
}

ResolvedScene resolve_scene(const fs::path& file, std::span<const std::string> overrides) {
  toml::table table;
  ResolvedScene resolved;
  resolved.scene = read(file, overrides, table);
  resolved.text = toml_text(table);
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

std::string resolved_scene_text(const fs::path& file, std::span<const std::string> overrides) {
  return resolve_scene(file, overrides).text;
}

double scene_friction(const fs::path& file) {
  return load_toml(file)["contact"]["friction"].value_or(Scene{}.friction);
}

std::string mesh_key(const Polyhedron& mesh) {
  Packer packer;
  packer.list(mesh.vertices(), [&](const Vec3& vertex) { packer.fixed(vertex); });
  for (int f = 0; f < mesh.face_count(); ++f) packer.list(mesh.face(f));
  return content_key(packer.bytes());
}

// Where scenes are found by name.

fs::path scene_folder() {
  if (const char* chosen = std::getenv("BALLAST_SCENES"); chosen && *chosen) return chosen;
  std::error_code unreadable;
  const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
  const fs::path installed = program.parent_path().parent_path() / "share/ballast/scenes";
  if (!unreadable && is_folder(installed)) return installed;
  return BALLAST_SCENE_FOLDER;  // of the source tree: problems/scenes
}

std::vector<std::pair<std::string, std::string>> list_scenes() {
  std::vector<std::pair<std::string, std::string>> scenes;
  const fs::path folder = scene_folder();
  if (!is_folder(folder)) throw SceneFileError(folder.string() + ": no such folder of scenes");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const toml::table table = load_toml(entry.path());
    scenes.emplace_back(entry.path().stem().string(),
                        table["scene"]["title"].value_or(std::string()));
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

fs::path find_scene(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  if (is_file(path)) return path;
  const bool is_name =
      !name_or_path.empty() && !path.has_parent_path() && path.extension() != ".toml";
  if (is_there(path) && !is_folder(path))
    throw SceneFileError(name_or_path + ": a pipe or a device, expected a scene file");
  if (!is_name) throw SceneFileError(name_or_path + ": no such scene file");
  const fs::path named = scene_folder() / (name_or_path + ".toml");
  if (is_file(named)) return named;
  std::vector<std::string> there;
  for (const auto& [name, title] : list_scenes()) there.push_back(name);
  throw SceneFileError(name_or_path + ": no scene of this name" +
                       did_you_mean(name_or_path, there) + ", expected a file or one of " +
                       joined(there));
}

}  // namespace ballast
