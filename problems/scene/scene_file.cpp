#include "problems/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/shape/mesh_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_bodies.hpp"
#include "problems/scene/scene_key.hpp"
#include "problems/scene/scene_keys.hpp"
#include "problems/scene/toml_text.hpp"

namespace ballast {
namespace {

/// A file may have blanks and umlauts in its name, a scene may not.
std::string name_of_file(const std::filesystem::path& file) {
  std::string name = file.stem().string();
  for (char& c : name)
    if (!is_plain(std::string_view(&c, 1), "_-.")) c = '_';
  if (name.empty() || name[0] == '.') name.insert(0, 1, '_');
  return name;
}

void read_head(TomlTable table, Scene& scene, const std::filesystem::path& file) {
  scene.name = name_of_file(file);
  read_keys(table, head_keys, scene);
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
  const GravityText given = read_section(
      std::move(table), gravity_keys, [](const TomlTable& own, const GravityText& gravity) {
        if (gravity.direction.norm() == 0.0)
          own.fail("direction", "has no direction, expected a vector that is not zero");
      });
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
    classes.push_back(read_section(std::move(table), distribution_keys));
    sum += classes.back().fraction;
  }
  if (std::abs(sum - 1.0) > 1e-9)
    grains.fail("distribution", "fractions sum to " +
                                    toml_value_text(toml::value<double>(sum), 30) + ", expected 1");
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

GrainsSpec read_grains(TomlTable table, const std::filesystem::path& folder) {
  GrainsText given;
  read_keys(table, grains_keys, given);
  GrainsSpec grains;
  grains.count = given.count;
  grains.seed = given.seed;
  grains.density = given.density;
  grains.size_convention =
      given.size == "radius" ? SizeConvention::radius : SizeConvention::diameter;
  grains.distribution = read_distribution(table);
  grains.shape = read_section(table.section("shape"), grain_shape_keys, check_grain_shape);
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
                               toml_value_text(toml::value<double>(widest), 30) + " [m]";
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

void check_drive(const TomlTable& table, const DriveSpec& drive) {
  if (drive.f_min_over_weight > drive.f_max_over_weight)
    table.fail("f_min_over_weight", "larger than f_max_over_weight, expected at most that");
}

void check_volume(const TomlTable& table, const ControlVolumeSpec& volume, const BoxSpec& box) {
  if (2.0 * volume.margin_x >= box.length)
    table.fail("margin_x", "leaves nothing, expected less than half of box.length");
  if (2.0 * volume.margin_y >= box.width)
    table.fail("margin_y", "leaves nothing, expected less than half of box.width");
}

void read_numerics(TomlTable& root, Scene& scene) {
  // resolved only where given: a run from before it keeps its text and its key
  if (root.has("sleep"))
    scene.sleep = read_section(
        root.section("sleep"), sleep_keys, [&](const TomlTable& table, const SleepSpec& sleep) {
          if (sleep.enabled && scene.gravity.isZero(0.0))
            table.fail("enabled", "rest is measured in g h, expected a gravity.magnitude > 0");
        });
  if (!root.has("grains")) scene.solver = SolverSpec::for_any_scene();
  TomlTable solver = root.section("solver");
  read_keys(solver, solver_keys, scene.solver);
  solver.finish();
  scene.correction = read_section(root.section("correction"), correction_keys);
  scene.detection = read_section(root.section("detection"), detection_keys);
  scene.record = read_section(root.section("record"), record_keys);
}

/// The vibrated box: everything is made from the grains and the box.
void read_box_scene(TomlTable& root, Scene& scene, const std::filesystem::path& folder) {
  for (const char* key : {"body", "wall"})
    if (root.has(key))
      root.fail(key, "given together with [grains], which make their own bodies and walls");
  if (scene.gravity.z() >= 0.0 || scene.gravity.x() != 0.0 || scene.gravity.y() != 0.0)
    root.fail("gravity",
              "grains are deposited along -z, expected magnitude > 0 and direction [0, 0, -1]");
  scene.grains = read_grains(root.section("grains"), folder);
  scene.box = read_section(
      root.section("box"), box_keys,
      [&](const TomlTable& table, const BoxSpec& box) { check_box(table, box, *scene.grains); });
  scene.deposit = read_section(root.section("deposit"), deposit_keys, check_deposit);
  scene.drive = read_section(root.section("drive"), drive_keys, check_drive);
  scene.control_volume = read_section(root.section("control_volume"), control_volume_keys,
                                      [&](const TomlTable& table, const ControlVolumeSpec& volume) {
                                        check_volume(table, volume, scene.box);
                                      });
}

void read_body_scene(TomlTable& root, Scene& scene, const std::filesystem::path& folder,
                     const std::string& file) {
  for (const char* key : {"box", "deposit", "drive", "control_volume"})
    if (root.has(key)) root.fail(key, "has no meaning without [grains]");
  scene.walls = read_walls(root);
  scene.bodies = read_bodies(root, folder, scene.walls);
  if (scene.walls.empty() && scene.bodies.empty())
    throw SceneFileError(
        file +
        ": nothing in it, expected [grains] with [box], or at least one [[body]] or [[wall]]");
}

Scene read(const std::filesystem::path& file, std::span<const std::string> overrides,
           toml::table& resolved) {
  const toml::table table = load_toml(file, overrides);
  TomlTable root(file.string(), table, resolved);
  for (const char* key :
       {"scene", "gravity", "contact", "body", "wall", "grains", "box", "deposit", "drive",
        "solver", "sleep", "correction", "detection", "record", "control_volume"})
    root.know(key);
  root.finish();  // a misspelt section first: what follows depends on which sections there are
  // grains decide the kind of scene: a box to be filled, or single bodies and walls
  Scene scene;
  read_head(root.section("scene"), scene, file);
  scene.gravity = read_gravity(root.section("gravity"));
  TomlTable contact = root.section("contact");
  read_keys(contact, contact_keys, scene);
  contact.finish();
  if (root.has("grains"))
    read_box_scene(root, scene, file.parent_path());
  else
    read_body_scene(root, scene, file.parent_path(), file.string());
  read_numerics(root, scene);
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, std::span<const std::string> overrides) {
  toml::table resolved;
  return read(file, overrides, resolved);
}

ResolvedScene resolve_scene(const std::filesystem::path& file,
                            std::span<const std::string> overrides) {
  toml::table table;
  ResolvedScene resolved;
  resolved.scene = read(file, overrides, table);
  resolved.text = toml_text(table);
  resolved.key = scene_key(resolved.scene, resolved.text);
  return resolved;
}

std::string resolved_scene_text(const std::filesystem::path& file,
                                std::span<const std::string> overrides) {
  return resolve_scene(file, overrides).text;
}

}  // namespace ballast
