#include "problems/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "geometry/shape/mesh_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_bodies.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using enum Presence;

constexpr NumberRange fill_range{"a number > 0 and <= 0.5", 0.0, 0.5, false, true};
constexpr NumberRange axis_ratio{"an axis ratio > 0.1 and <= 1", 0.1, 1.0, false, true};
constexpr NumberRange roughness_range{"a number from 0 to below 0.15", 0.0, 0.15, true, false};

// Grains in a box.

/// Reads the size classes by number, with fractions that sum to 1; without the key, the paper's.
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
  table.read("count", &grains.count, whole(1, 1'000'000), required);
  table.read("seed", &grains.seed);
  table.read("density", &grains.density, in(positive, "kg/m^3"));
  table.read("size", &size, one_of({"radius", "diameter"}));
  const std::vector<std::string> meshes = table.texts("meshes");
  grains.size_convention = size == "radius" ? SizeConvention::radius : SizeConvention::diameter;
  grains.distribution = read_distribution(table);
  read_grain_shape(table.section("shape"), grains.shape);
  // the resolved text has absolute paths of files, so that it can be read elsewhere
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

void read_box(TomlTable table, BoxSpec& s, const GrainsSpec& grains, const DepositSpec& deposit) {
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
  const std::tuple<const char*, double, double> sides[] = {
      {"length", s.length, widest * deposit.tiles_x}, {"width", s.width, widest * deposit.tiles_y}};
  for (const auto& [key, side, least] : sides)
    if (side < least)
      table.fail(key, "narrower than the largest grain, expected at least " +
                          toml_value_text(toml::value<double>(least)) + " [m]");
}

void read_deposit(TomlTable table, DepositSpec& s, const GrainsSpec& grains) {
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
  table.read("tiles_x", &s.tiles_x, whole(1, 1000), only_where_given);
  table.read("tiles_y", &s.tiles_y, whole(1, 1000), only_where_given);
  table.finish();
  if (grains.count % s.tiles() != 0)
    table.fail(s.tiles_x > 1 ? "tiles_x" : "tiles_y",
               "grains.count is no multiple of " + std::to_string(s.tiles()) + " tiles");
  // limits the number of steps, as for the scene
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
  std::string name = made_plain(file.stem().string(), "_-.");
  if (name.empty() || name[0] == '.') name.insert(0, 1, '_');
  return name;
}

void read_head(TomlTable table, Scene& scene, const fs::path& file) {
  scene.name = name_of_file(file);
  table.read("name", &scene.name);
  table.read("title", &scene.title);
  table.read("step", &scene.step, in(positive, "s"));
  table.read("duration", &scene.duration, in(positive, "s"));
  table.read("period", &scene.period.vector, of_unit("m"), only_where_given);
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
void read_box_scene(TomlTable& root, Scene& scene, const fs::path& file) {
  for (const char* key : {"body", "wall", "crowd"})
    if (root.has(key))
      root.fail(key, "given together with [grains], which make their own bodies and walls");
  if (scene.gravity.z() >= 0.0 || scene.gravity.x() != 0.0 || scene.gravity.y() != 0.0)
    root.fail("gravity",
              "grains are deposited along -z, expected magnitude > 0 and direction [0, 0, -1]");
  if (scene.period.repeats())
    throw Error(file.string() + ": scene.period has no meaning with [grains], in a box");
  scene.grains = read_grains(root.section("grains"), file.parent_path());
  read_deposit(root.section("deposit"), scene.deposit, *scene.grains);
  read_box(root.section("box"), scene.box, *scene.grains, scene.deposit);
  read_drive(root.section("drive"), scene.drive);
  read_control_volume(root.section("control_volume"), scene.control_volume, scene.box);
}

void read_body_scene(TomlTable& root, Scene& scene, const fs::path& file) {
  for (const char* key : {"box", "deposit", "drive", "control_volume"})
    if (root.has(key)) root.fail(key, "has no meaning without [grains]");
  read_bodies(root, file.parent_path(), scene);
  if (scene.walls.empty() && scene.bodies.empty())
    throw Error(file.string() +
                ": nothing in it, expected [grains] with [box], or at least one [[body]], "
                "[[crowd]] or [[wall]]");
}

Scene read(TomlTable& root, const fs::path& file) {
  for (const char* key :
       {"scene", "gravity", "contact", "body", "wall", "crowd", "grains", "box", "deposit", "drive",
        "solver", "correction", "detection", "record", "control_volume"})
    root.know(key);
  root.finish();  // finds a misspelt section first: the rest depends on which sections exist
  // grains decide the kind of scene: a box to be filled, or single bodies and walls
  Scene scene;
  read_head(root.section("scene"), scene, file);
  scene.gravity = read_gravity(root.section("gravity"));
  TomlTable contact = root.section("contact");
  contact.read("friction", &scene.friction, in(friction_range));
  contact.read("restitution", &scene.restitution, in(zero_to_one));
  const std::vector<TomlTable> pairs = contact.sections("pair");
  contact.finish();
  if (root.has("grains")) {
    if (!pairs.empty()) contact.fail("pair", "has no meaning with [grains], of one material");
    read_box_scene(root, scene, file);
  } else {
    read_body_scene(root, scene, file);
    read_material_pairs(pairs, scene);
    // These defaults serve all masses and shapes: where sweeps stagnate, as with heavy bodies on
    // light ones, auto turns to Newton. Sweeps are cheap beside a Newton step; auto decides when.
    scene.solver = {.name = "auto", .max_iterations = 100'000};
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

// Scenes by name, and single values of a scene without reading all of it.

double scene_friction(const fs::path& file) {
  return load_toml(file)["contact"]["friction"].value_or(Scene{}.friction);
}

fs::path scene_folder() {
  if (const char* chosen = std::getenv("BALLAST_SCENES"); chosen && *chosen) return chosen;
  std::error_code unreadable;
  const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
  const fs::path installed = program.parent_path().parent_path() / "share/ballast/scenes";
  if (!unreadable && is_folder(installed)) return installed;
  return BALLAST_SCENE_FOLDER;  // of the source tree: problems/scenes
}

std::vector<std::pair<std::string, std::string>> list_scenes(std::string* unreadable) {
  std::vector<std::pair<std::string, std::string>> scenes;
  const fs::path folder = scene_folder();
  if (!is_folder(folder)) throw Error(folder.string() + ": no such folder of scenes");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    try {
      scenes.emplace_back(entry.path().stem().string(),
                          load_toml(entry.path())["scene"]["title"].value_or(std::string()));
    } catch (const Error& error) {
      if (unreadable) add_to_list(*unreadable, error.what());
    }
  }
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

fs::path find_scene(const std::string& name_or_path) {
  const fs::path path(name_or_path);
  if (is_file(path)) return path;
  const bool is_name =
      !name_or_path.empty() && !path.has_parent_path() && path.extension() != ".toml";
  if (path_exists(path) && !is_folder(path))
    throw Error(name_or_path + ": a pipe or a device, expected a scene file");
  if (!is_name) throw Error(name_or_path + ": no such scene file");
  const fs::path named = scene_folder() / (name_or_path + ".toml");
  if (is_file(named)) return named;
  std::vector<std::string> there;
  for (const auto& [name, title] : list_scenes()) there.push_back(name);
  throw Error(name_or_path + ": no scene of this name" + did_you_mean(name_or_path, there) +
              ", expected a file or one of " + joined(there));
}

}  // namespace ballast
