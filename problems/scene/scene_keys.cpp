#include "problems/scene/scene_keys.hpp"

namespace ballast {
namespace {

constexpr NumberRange fill_range{"a number > 0 and <= 0.5", 0.0, 0.5, false, true};
constexpr NumberRange axis_ratio{"an axis ratio > 0.1 and <= 1", 0.1, 1.0, false, true};
constexpr NumberRange roughness_range{"a number from 0 to below 0.15", 0.0, 0.15, true, false};

const ValueRule anything;
ValueRule in(const NumberRange& range, const char* unit = "") {
  return {.range = range, .unit = unit};
}
ValueRule whole(int low, int high = 1'000'000'000) { return {.low = low, .high = high}; }
ValueRule one_of(std::vector<const char*> words) { return {.words = std::move(words)}; }

}  // namespace

SceneKeys head_keys(Scene& s) {
  return {
      {"name", &s.name, anything, "letters, digits, `_`, `-`, `.`; names the results' folder",
       Presence::optional, "the file's name"},
      {"title", &s.title, anything, "one line for lists and reports"},
      {"step", &s.step, in(positive, "s"), "step h; at most the duration"},
      {"duration", &s.duration, in(positive, "s"),
       "simulated time; with grains: of the driven phase"},
  };
}

SceneKeys gravity_keys(GravityText& s) {
  return {
      {"magnitude", &s.magnitude, in(not_negative, "m/s^2"), "g"},
      {"direction", &s.direction, anything,
       "any length but 0; with grains it must be straight down"},
  };
}

SceneKeys contact_keys(Scene& s) {
  return {
      {"friction", &s.friction, in(friction_range), "Coulomb's μ between bodies"},
      {"restitution", &s.restitution, in(zero_to_one),
       "Newton's e; lowered where it would give energy ([method.md](../theory/method.md))"},
  };
}

SceneKeys solver_keys(SolverSpec& s) {
  return {
      {"name", &s.name, anything,
       "as listed by `ballast solvers`; without grains the default is \"auto\", which holds "
       "whatever the masses are"},
      {"tolerance", &s.tolerance, in(not_negative, "g h"),
       "scaled natural map, rms over contacts, in units of g h (of 1 m/s without gravity)"},
      {"max_iterations", &s.max_iterations, whole(1),
       "Gauss–Seidel sweeps, Newton steps, ... per step; without grains the default is 1000"},
      {"max_seconds", &s.max_seconds, in(positive, "s"),
       "wall clock per step; a finite one makes runs irreproducible"},
      {"warm_start", &s.warm_start, anything, "start from the last step's impulses"},
      {"change_tolerance", &s.change_tolerance, in(part_of_one, "relative"),
       "above 0, LMGC90's rule \"QM/16\" stops in place of `tolerance`: what one more solution of "
       "each contact alone would change ([method.md](../theory/method.md)); its scripts have "
       "1.666e-4. `max_iterations` must leave room for it",
       Presence::only_where_given, "off"},
      {"change_every", &s.change_every, whole(1),
       "iterations between two looks of that rule, for backends whose iterations are sweeps",
       Presence::only_where_given},
  };
}

SceneKeys correction_keys(CorrectionSpec& s) {
  return {
      {"enabled", &s.enabled, anything, "moves overlapping bodies apart, velocities untouched"},
      {"slop", &s.slop, in(not_negative, "m"), "overlap left alone"},
      {"fraction", &s.fraction, in(part_of_one),
       "of the overlap beyond the slop that is removed per step"},
      {"sweeps", &s.sweeps, whole(1), "Gauss–Seidel sweeps of the correction"},
  };
}

SceneKeys detection_keys(DetectionSettings& s) {
  return {
      {"max_points", &s.max_points, whole(1), "contact points per pair of bodies"},
      {"skin", &s.skin, in(not_negative, "m"),
       "margin of the broad phase; 0: chosen from the shapes"},
      {"use_cache", &s.use_cache, anything,
       "start from the last step's separating axes; the contacts are the same without"},
  };
}

SceneKeys record_keys(RecordSpec& s) {
  return {
      {"pose_rate", &s.pose_rate, in(positive, "1/s"), "stored poses per simulated second"},
      {"state_rate", &s.state_rate, in(not_negative, "1/s"),
       "whole states, with contacts and impulses, kept per simulated second in `states/` "
       "([records.md](records.md)); 0: none"},
      {"checkpoint_seconds", &s.checkpoint_seconds, in(positive, "s"),
       "wall clock between checkpoints"},
      {"forces", &s.forces, anything,
       "the contacts of every stored frame, with their forces, in `record.h5`: several times as "
       "much as the poses",
       Presence::only_where_given},
  };
}

SceneKeys grains_keys(GrainsSpec& s, GrainsText& text) {
  return {
      {"count", &s.count, whole(1, 1'000'000), "grains in the box", Presence::required},
      {"seed", &s.seed, anything, "of shapes, sizes, places and orientations"},
      {"density", &s.density, in(positive, "kg/m^3"), "of the grains' material"},
      {"size", &text.size, one_of({"radius", "diameter"}),
       "how `distribution.size` is read: largest distance from the centre of mass to a vertex "
       "(\"radius\"), or twice that (\"diameter\")"},
      {"meshes", &text.meshes, anything,
       "OBJ or STL files, used in turn instead of generated shapes (their convex hulls, scaled to "
       "the sizes); relative to the scene file"},
  };
}

SceneKeys distribution_keys(SizeClass& s) {
  return {
      {"size", &s.size, in(positive, "m"), "of one class; see `grains.size`", Presence::required,
       "the paper's three classes: 0.025, 0.0375, 0.05"},
      {"fraction", &s.fraction, in(part_of_one, "by number"),
       "the fractions of `[[grains.distribution]]` sum to 1", Presence::required,
       "0.50, 0.34, 0.16"},
  };
}

SceneKeys grain_shape_keys(GrainShapeSettings& s) {
  return {
      {"min_vertices", &s.min_vertices, whole(4, 200), "of the generated hulls"},
      {"max_vertices", &s.max_vertices, whole(4, 200), "at least `min_vertices`"},
      {"elongation_min", &s.elongation_min, in(axis_ratio), "intermediate / longest axis"},
      {"elongation_max", &s.elongation_max, in(axis_ratio), "at least `elongation_min`"},
      {"flatness_min", &s.flatness_min, in(axis_ratio), "shortest / longest axis"},
      {"flatness_max", &s.flatness_max, in(axis_ratio), "at least `flatness_min`"},
      {"roughness", &s.roughness, in(roughness_range),
       "relative standard deviation of the vertex radii"},
  };
}

SceneKeys box_keys(BoxSpec& s) {
  return {
      {"length", &s.length, in(positive, "m"),
       "along x, the driven direction; at least the largest grain's width", Presence::required},
      {"width", &s.width, in(positive, "m"), "along y; at least the largest grain's width",
       Presence::required},
      {"friction_horizontal", &s.friction_horizontal, in(friction_range), "μ at floor and lid"},
      {"friction_vertical", &s.friction_vertical, in(friction_range), "μ at the side walls"},
  };
}

SceneKeys deposit_keys(DepositSpec& s) {
  return {
      {"step", &s.step, in(positive, "s"), "h until the lid is raised"},
      {"friction", &s.friction, in(friction_range),
       "between grains and at floor and lid until the drive begins"},
      {"fill_fraction", &s.fill_fraction, in(fill_range, "of the bounding spheres"),
       "in the rain: its height follows"},
      {"max_time", &s.max_time, in(positive, "s"),
       "a rain that is not at rest by then is an error"},
      {"rest_velocity", &s.rest_velocity, in(positive, "m/s"),
       "rms velocity of the grains that counts as rest"},
      {"lid_pressure_weight", &s.lid_pressure_weight, in(not_negative, "grain weights"),
       "load on the lid while it presses; 0: it is only placed"},
      {"lid_time", &s.lid_time, in(not_negative, "s"), "how long it presses"},
      {"settle_time", &s.settle_time, in(not_negative, "s"), "rest under the raised lid"},
      {"settle_step", &s.settle_step, in(positive, "s"), "h of that rest"},
      {"gravity", &s.gravity, in(not_negative, "m/s^2"),
       "until the drive begins; 0: `gravity.magnitude`. Given, one packing serves drives under "
       "several g"},
      {"solver", &s.solver, anything,
       "of the deposit: the drive's solver, step and friction don't enter, so all drives can start "
       "from one packing"},
      {"tolerance", &s.tolerance, in(not_negative, "g h"), "of that solver"},
      {"max_iterations", &s.max_iterations, whole(1), "of that solver"},
  };
}

SceneKeys drive_keys(DriveSpec& s) {
  return {
      {"frequency", &s.frequency, in(positive, "Hz"), "ν"},
      {"f_max_over_weight", &s.f_max_over_weight, in(not_negative, "grain weights"),
       "largest force on the wall, in weights of all grains"},
      {"f_min_over_weight", &s.f_min_over_weight, in(not_negative, "grain weights"),
       "smallest, at most the largest"},
      {"wall_mass_over_grains", &s.wall_mass_over_grains, in(positive, "grain masses"),
       "the wall's mass in masses of all grains"},
      {"lid_raise", &s.lid_raise, in(not_negative, "m"), "gap that the lid leaves"},
      {"start_noise", &s.start_noise, in(not_negative, "m"),
       "the centres of the grains start the drive moved by up to this along each axis, drawn "
       "evenly: "
       "1e-12 makes replicas, whose differences are chaos alone",
       Presence::only_where_given},
      {"start_noise_seed", &s.start_noise_seed, anything, "of that", Presence::only_where_given},
  };
}

SceneKeys control_volume_keys(ControlVolumeSpec& s) {
  return {
      {"margin_x", &s.margin_x, in(not_negative, "m"),
       "where the solid fraction is taken: a box at rest this far from both walls x, clear of the "
       "driven wall's motion"},
      {"margin_y", &s.margin_y, in(not_negative, "m"), "from both walls y"},
      {"margin_floor", &s.margin_floor, in(not_negative, "m"), "from the floor"},
      {"margin_top", &s.margin_top, in(not_negative, "m"),
       "below the packing's top before the drive"},
  };
}

SceneKeys wall_keys(WallSpec& s, std::string& motion) {
  return {
      {"name", &s.name, anything, "unique among walls and bodies", Presence::optional,
       "wall_0, wall_1, ..."},
      {"normal", &s.normal, anything, "any length but 0; points to the side where bodies are",
       Presence::required},
      {"offset", &s.offset, in(any_number, "m"), "of the plane normal·x = offset"},
      {"friction", &s.friction, in(friction_range), "μ of contacts with this wall"},
      {"motion", &motion, one_of({"fixed", "prescribed", "driven"}),
       "prescribed and driven walls have the keys below"},
  };
}

SceneKeys prescribed_wall_keys(WallSpec& s) {
  return {
      {"amplitude", &s.amplitude, in(any_number, "m"),
       "prescribed only: the wall is displaced by amplitude · (1 − cos 2πνt), a vector",
       Presence::required},
      {"frequency", &s.frequency, in(not_negative, "Hz"), "prescribed only: ν", Presence::required},
  };
}

SceneKeys driven_wall_keys(WallSpec& s) {
  return {
      {"mass", &s.mass, in(positive, "kg"), "driven only: the wall moves along its normal",
       Presence::required},
  };
}

SceneKeys load_keys(HarmonicLoad& s) {
  return {
      {"f_max", &s.f_max, in(not_negative, "N"),
       "driven only: compressive force along +normal, as f(t) above", Presence::required},
      {"f_min", &s.f_min, in(not_negative, "N"), "driven only: at most `load.f_max`"},
      {"frequency", &s.frequency, in(not_negative, "Hz"), "driven only: ν", Presence::required},
  };
}

SceneKeys body_keys(BodySpec& s, ShapeText& shape) {
  return {
      {"name", &s.name, anything, "unique among walls and bodies", Presence::optional,
       "body_0, body_1, ..."},
      {"shape", &shape.kind, one_of({"box", "sphere", "grain", "mesh"}),
       "each has keys of its own, below", Presence::required},
      {"locked", &shape.locked, anything,
       "any of \"x\", \"y\", \"z\" (translations along the world's axes) and \"rotation\" (all "
       "three)"},
      {"mass", &s.mass, in(positive, "kg"), "or `density`", Presence::only_where_given, ""},
      {"density", &shape.density, in(positive, "kg/m^3"),
       "one of `density` and `mass` is required unless the body is locked in everything",
       Presence::only_where_given, ""},
      {"position", &s.pose.position, in(any_number, "m"),
       "where the shape's origin goes: the centre of mass, for a mesh the file's origin"},
      {"velocity", &s.velocity, in(any_number, "m/s"), "of the centre of mass"},
      {"spin", &s.spin, in(any_number, "rad/s"), "angular velocity, world frame"},
  };
}

SceneKeys shape_keys(const std::string& kind, ShapeText& s) {
  if (kind == "box")
    return {
        {"size", &s.size, in(any_number, "m"), "box: three full side lengths > 0",
         Presence::required},
    };
  if (kind == "sphere")
    return {
        {"radius", &s.radius, in(positive, "m"), "sphere: circumradius of the polyhedron",
         Presence::required},
        {"subdivisions", &s.subdivisions, whole(0, 5), "sphere: 20 · 4ⁿ faces"},
    };
  if (kind == "grain")
    return {
        {"radius", &s.radius, in(positive, "m"), "grain: largest distance centre of mass – vertex",
         Presence::required},
        {"seed", &s.seed, anything, "grain: of its shape"},
    };
  // mesh
  return {
      {"file", &s.file, anything,
       "mesh: OBJ or STL of a closed convex body, relative to the scene file", Presence::required},
      {"scale", &s.scale, in(positive, "m per unit of the file"),
       "mesh: 0.001 for a file in millimetres"},
      {"hull", &s.hull, anything,
       "mesh: take the convex hull of the vertices instead of insisting on convexity"},
  };
}

SceneKeys orientation_keys(OrientationText& s) {
  return {
      {"axis", &s.axis, anything, "of the rotation from the shape's frame; any length but 0"},
      {"angle_degrees", &s.angle_degrees, in(any_number, "degrees"),
       "about the axis, right-handed"},
  };
}

SceneKeys force_keys(ForceSpec& s) {
  return {
      {"constant", &s.constant, in(any_number, "N"),
       "force on the centre of mass, world frame: constant + amplitude · cos(2π · frequency · t + "
       "phase)"},
      {"amplitude", &s.amplitude, in(any_number, "N"), "its swinging part"},
      {"frequency", &s.frequency, in(not_negative, "Hz"), "of the swinging part"},
      {"phase", &s.phase, in(any_number, "rad"), "of the swinging part"},
  };
}

void read_keys(TomlTable& table, const SceneKeys& keys) {
  for (const SceneKey& key : keys) {
    table.know(key.name);
    const bool is_quiet = key.presence == Presence::only_where_given;
    if (is_quiet && !table.has(key.name)) continue;
    const std::string by_default = kept_text(key.place);
    table.read(key.name, key.rule, key.presence == Presence::required, key.place);
    if (is_quiet && kept_text(key.place) == by_default) table.leave_unsaid(key.name);
  }
}

}  // namespace ballast
