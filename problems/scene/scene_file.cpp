#include "problems/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/shape/mesh_file.hpp"
#include "problems/scene/scene_bodies.hpp"
#include "problems/scene/toml_reader.hpp"
#include "problems/scene/toml_text.hpp"

namespace ballast {
namespace {

constexpr std::int64_t no_limit = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t int_limit = 1'000'000'000;
constexpr NumberRange fill_range{"a number > 0 and <= 0.5", 0.0, 0.5, false, true};
constexpr NumberRange axis_ratio{"an axis ratio > 0.1 and <= 1", 0.1, 1.0, false, true};

int whole_int(TomlTable& table, const char* key, int low, int fallback) {
  return static_cast<int>(table.whole(key, low, int_limit, fallback));
}

void read_head(TomlTable table, Scene& scene, const std::filesystem::path& file) {
  scene.name = table.text("name", file.stem().string());
  scene.title = table.text("title", "");
  scene.step = table.number("step", positive, "s", scene.step);
  scene.duration = table.number("duration", positive, "s", scene.duration);
  // a name is also a folder's name
  const bool plain =
      scene.name.find_first_not_of(
          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.") == std::string::npos;
  if (scene.name.empty() || scene.name[0] == '.' || !plain)
    table.fail("name", "expected letters, digits, _, - and .");
  if (scene.step > scene.duration)
    table.fail("step", "longer than the scene, expected step <= duration");
  if (scene.duration / scene.step > 1e12)
    table.fail("step", "too short, expected at most 1e12 steps");
  table.finish();
}

void read_gravity(TomlTable table, Scene& scene) {
  const double magnitude = table.number("magnitude", not_negative, "m/s^2", 9.81);
  const Vec3 direction = table.vector("direction", "", Vec3(0, 0, -1));
  if (direction.norm() == 0.0)
    table.fail("direction", "has no direction, expected a vector that is not zero");
  scene.gravity = magnitude * direction.normalized();
  table.finish();
}

void read_contact(TomlTable table, Scene& scene) {
  scene.friction = table.number("friction", not_negative, "", scene.friction);
  scene.restitution = table.number("restitution", zero_to_one, "", scene.restitution);
  table.finish();
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
    classes.push_back(
        {table.number("size", positive, "m"), table.number("fraction", part_of_one, "by number")});
    sum += classes.back().fraction;
    table.finish();
  }
  if (std::abs(sum - 1.0) > 1e-9)
    grains.fail("distribution", "fractions sum to " +
                                    toml_value_text(toml::value<double>(sum), 30) + ", expected 1");
  return classes;
}

GrainShapeSettings read_grain_shape(TomlTable table) {
  GrainShapeSettings shape;
  shape.min_vertices = static_cast<int>(table.whole("min_vertices", 4, 200, shape.min_vertices));
  shape.max_vertices = static_cast<int>(table.whole("max_vertices", 4, 200, shape.max_vertices));
  if (shape.min_vertices > shape.max_vertices)
    table.fail("min_vertices", "larger than max_vertices, expected at most that");
  shape.elongation_min = table.number("elongation_min", axis_ratio, "", shape.elongation_min);
  shape.elongation_max = table.number("elongation_max", axis_ratio, "", shape.elongation_max);
  if (shape.elongation_min > shape.elongation_max)
    table.fail("elongation_min", "larger than elongation_max");
  shape.flatness_min = table.number("flatness_min", axis_ratio, "", shape.flatness_min);
  shape.flatness_max = table.number("flatness_max", axis_ratio, "", shape.flatness_max);
  if (shape.flatness_min > shape.flatness_max)
    table.fail("flatness_min", "larger than flatness_max");
  shape.roughness = table.number("roughness", {"a number from 0 to 0.2", 0.0, 0.2, true, true}, "",
                                 shape.roughness);
  table.finish();
  return shape;
}

GrainsSpec read_grains(TomlTable table, const std::filesystem::path& folder) {
  GrainsSpec grains;
  grains.count = static_cast<int>(table.whole("count", 1, 1'000'000));
  grains.seed = static_cast<std::uint64_t>(table.whole("seed", 0, no_limit, 1));
  grains.density = table.number("density", positive, "kg/m^3", grains.density);
  const bool radius = table.choice("size", {"radius", "diameter"}, "radius") == "radius";
  grains.size_convention = radius ? SizeConvention::radius : SizeConvention::diameter;
  grains.distribution = read_distribution(table);
  grains.shape = read_grain_shape(table.section("shape"));
  toml::array kept;
  for (const std::string& name : table.texts("meshes")) {
    grains.meshes.push_back(mesh_path(folder, name));
    kept.push_back(grains.meshes.back());
    try {
      read_mesh_hull(grains.meshes.back());
    } catch (const MeshFileError& error) {
      table.fail("meshes", error.what());
    }
  }
  table.replace_resolved("meshes", kept);
  table.finish();
  return grains;
}

BoxSpec read_box(TomlTable table, const GrainsSpec& grains) {
  BoxSpec box;
  box.length = table.number("length", positive, "m");
  box.width = table.number("width", positive, "m");
  box.friction_horizontal =
      table.number("friction_horizontal", not_negative, "", box.friction_horizontal);
  box.friction_vertical =
      table.number("friction_vertical", not_negative, "", box.friction_vertical);
  double widest = 0.0;
  for (const SizeClass& c : grains.distribution)
    widest =
        std::max(widest, grains.size_convention == SizeConvention::radius ? 2.0 * c.size : c.size);
  const std::string expected = "narrower than the largest grain, expected at least " +
                               toml_value_text(toml::value<double>(widest), 30) + " [m]";
  if (box.length < widest) table.fail("length", expected);
  if (box.width < widest) table.fail("width", expected);
  table.finish();
  return box;
}

DepositSpec read_deposit(TomlTable table) {
  DepositSpec deposit;
  deposit.step = table.number("step", positive, "s", deposit.step);
  deposit.friction = table.number("friction", not_negative, "", deposit.friction);
  deposit.fill_fraction =
      table.number("fill_fraction", fill_range, "of the bounding spheres", deposit.fill_fraction);
  deposit.max_time = table.number("max_time", positive, "s", deposit.max_time);
  deposit.rest_velocity = table.number("rest_velocity", positive, "m/s", deposit.rest_velocity);
  deposit.lid_pressure_weight = table.number("lid_pressure_weight", not_negative, "grain weights",
                                             deposit.lid_pressure_weight);
  deposit.lid_time = table.number("lid_time", not_negative, "s", deposit.lid_time);
  deposit.settle_time = table.number("settle_time", not_negative, "s", deposit.settle_time);
  deposit.settle_step = table.number("settle_step", positive, "s", deposit.settle_step);
  deposit.gravity = table.number("gravity", not_negative, "m/s^2", deposit.gravity);
  deposit.solver = table.text("solver", deposit.solver);
  deposit.tolerance = table.number("tolerance", not_negative, "g h", deposit.tolerance);
  deposit.max_iterations = whole_int(table, "max_iterations", 1, deposit.max_iterations);
  table.finish();
  return deposit;
}

DriveSpec read_drive(TomlTable table) {
  DriveSpec drive;
  drive.frequency = table.number("frequency", positive, "Hz", drive.frequency);
  drive.f_max_over_weight =
      table.number("f_max_over_weight", not_negative, "grain weights", drive.f_max_over_weight);
  drive.f_min_over_weight =
      table.number("f_min_over_weight", not_negative, "grain weights", drive.f_min_over_weight);
  if (drive.f_min_over_weight > drive.f_max_over_weight)
    table.fail("f_min_over_weight", "larger than f_max_over_weight, expected at most that");
  drive.wall_mass_over_grains =
      table.number("wall_mass_over_grains", positive, "grain masses", drive.wall_mass_over_grains);
  drive.lid_raise = table.number("lid_raise", not_negative, "m", drive.lid_raise);
  table.finish();
  return drive;
}

ControlVolumeSpec read_control_volume(TomlTable table, const BoxSpec& box) {
  ControlVolumeSpec volume;
  volume.margin_x = table.number("margin_x", not_negative, "m", volume.margin_x);
  volume.margin_y = table.number("margin_y", not_negative, "m", volume.margin_y);
  volume.margin_floor = table.number("margin_floor", not_negative, "m", volume.margin_floor);
  volume.margin_top = table.number("margin_top", not_negative, "m", volume.margin_top);
  if (2.0 * volume.margin_x >= box.length)
    table.fail("margin_x", "leaves nothing, expected less than half of box.length");
  if (2.0 * volume.margin_y >= box.width)
    table.fail("margin_y", "leaves nothing, expected less than half of box.width");
  table.finish();
  return volume;
}

/// Resolved only where given: a run from before it keeps its text and its key.
void read_sleep(TomlTable& root, Scene& scene) {
  if (!root.has("sleep")) return;
  TomlTable table = root.section("sleep");
  scene.sleep.enabled = table.flag("enabled", scene.sleep.enabled);
  scene.sleep.velocity = table.number("velocity", positive, "g h", scene.sleep.velocity);
  scene.sleep.steps = whole_int(table, "steps", 1, scene.sleep.steps);
  if (scene.sleep.enabled && scene.gravity.isZero(0.0))
    table.fail("enabled", "rest is measured in g h, expected a gravity.magnitude > 0");
  table.finish();
}

void read_numerics(TomlTable& root, Scene& scene) {
  read_sleep(root, scene);
  TomlTable solver = root.section("solver");
  scene.solver.name = solver.text("name", scene.solver.name);
  scene.solver.tolerance = solver.number("tolerance", not_negative, "g h", scene.solver.tolerance);
  scene.solver.max_iterations = whole_int(solver, "max_iterations", 1, scene.solver.max_iterations);
  scene.solver.max_seconds = solver.number("max_seconds", positive, "s", scene.solver.max_seconds);
  scene.solver.warm_start = solver.flag("warm_start", scene.solver.warm_start);
  solver.know(
      "islands");  // resolved only where given: a scene.toml from before it means what it meant
  if (solver.has("islands")) scene.solver.islands = solver.flag("islands");
  solver.finish();

  TomlTable correction = root.section("correction");
  scene.correction.enabled = correction.flag("enabled", scene.correction.enabled);
  scene.correction.slop = correction.number("slop", not_negative, "m", scene.correction.slop);
  scene.correction.fraction =
      correction.number("fraction", part_of_one, "", scene.correction.fraction);
  scene.correction.sweeps = whole_int(correction, "sweeps", 1, scene.correction.sweeps);
  correction.finish();

  TomlTable detection = root.section("detection");
  scene.detection.max_points = whole_int(detection, "max_points", 1, scene.detection.max_points);
  scene.detection.skin = detection.number("skin", not_negative, "m", scene.detection.skin);
  scene.detection.use_cache = detection.flag("use_cache", scene.detection.use_cache);
  // only where given: a scene.toml from before has neither
  if (detection.has("reuse_motion")) {
    scene.detection.reuse_motion =
        detection.number("reuse_motion", part_of_one, "of circumradii", 0.0);
    if (!scene.detection.use_cache) detection.fail("reuse_motion", "needs use_cache = true");
    if (scene.sleep.enabled)
      detection.fail("reuse_motion", "given together with sleep.enabled = true");
  }
  if (detection.has("refresh_steps")) {
    if (!detection.has("reuse_motion"))
      detection.fail("refresh_steps", "has no meaning without reuse_motion");
    scene.detection.refresh_steps =
        whole_int(detection, "refresh_steps", 1, scene.detection.refresh_steps);
  }
  detection.finish();

  TomlTable record = root.section("record");
  scene.record.pose_rate = record.number("pose_rate", positive, "1/s", scene.record.pose_rate);
  scene.record.state_rate =
      record.number("state_rate", not_negative, "1/s", scene.record.state_rate);
  scene.record.checkpoint_seconds =
      record.number("checkpoint_seconds", positive, "s", scene.record.checkpoint_seconds);
  scene.record.paraview = record.flag("paraview", scene.record.paraview);
  record.finish();
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
  scene.box = read_box(root.section("box"), *scene.grains);
  scene.deposit = read_deposit(root.section("deposit"));
  scene.drive = read_drive(root.section("drive"));
  scene.control_volume = read_control_volume(root.section("control_volume"), scene.box);
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
  Scene scene;
  read_head(root.section("scene"), scene, file);
  read_gravity(root.section("gravity"), scene);
  read_contact(root.section("contact"), scene);
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

std::string resolved_scene_text(const std::filesystem::path& file,
                                std::span<const std::string> overrides) {
  toml::table resolved;
  read(file, overrides, resolved);
  return toml_text(resolved);
}

}  // namespace ballast
