#include "problems/scene/scene_keys.hpp"

namespace ballast {
namespace {

constexpr NumberRange fill_range{"a number > 0 and <= 0.5", 0.0, 0.5, false, true};
constexpr NumberRange axis_ratio{"an axis ratio > 0.1 and <= 1", 0.1, 1.0, false, true};
constexpr NumberRange roughness_range{"a number from 0 to below 0.15", 0.0, 0.15, true, false};

}  // namespace

const SceneKeys<Scene> head_keys{
    {"name", text(&Scene::name), "letters, digits, `_`, `-`, `.`; names the results' folder",
     Presence::optional, "the file's name"},
    {"title", text(&Scene::title), "one line for lists and reports"},
    {"step", number(&Scene::step, positive, "s"), "step h; at most the duration"},
    {"duration", number(&Scene::duration, positive, "s"),
     "simulated time; with grains: of the driven phase"},
};

const SceneKeys<GravityText> gravity_keys{
    {"magnitude", number(&GravityText::magnitude, not_negative, "m/s^2"), "g"},
    {"direction", vector(&GravityText::direction),
     "any length but 0; with grains it must be straight down"},
};

const SceneKeys<Scene> contact_keys{
    {"friction", number(&Scene::friction, friction_range), "Coulomb's μ between bodies"},
    {"restitution", number(&Scene::restitution, zero_to_one),
     "Newton's e; lowered where it would give energy ([method.md](../theory/method.md))"},
};

const SceneKeys<SolverSpec> solver_keys{
    {"name", text(&SolverSpec::name),
     "as listed by `ballast solvers`; without grains the default is \"auto\", which holds "
     "whatever the masses are"},
    {"tolerance", number(&SolverSpec::tolerance, not_negative, "g h"),
     "scaled natural map, rms over contacts, in units of g h (of 1 m/s without gravity)"},
    {"max_iterations", whole(&SolverSpec::max_iterations, 1),
     "Gauss–Seidel sweeps, Newton steps, ... per step; without grains the default is 1000"},
    {"max_seconds", number(&SolverSpec::max_seconds, positive, "s"),
     "wall clock per step; a finite one makes runs irreproducible"},
    {"warm_start", flag(&SolverSpec::warm_start), "start from the last step's impulses"},
    {"change_tolerance", number(&SolverSpec::change_tolerance, part_of_one, "relative"),
     "above 0, LMGC90's rule \"QM/16\" stops in place of `tolerance`: what one more solution of "
     "each contact alone would change ([method.md](../theory/method.md)); its scripts have "
     "1.666e-4. `max_iterations` must leave room for it",
     Presence::only_where_given, "off"},
    {"change_every", whole(&SolverSpec::change_every, 1),
     "iterations between two looks of that rule, for backends whose iterations are sweeps",
     Presence::only_where_given},
    {"islands", flag(&SolverSpec::islands),
     "heaps that no contact joins are solved one by one, each to the tolerance and with "
     "`max_iterations` of its own; one heap: the same bits as with false. Pays where several "
     "heaps are. A deposit never does",
     Presence::only_where_given},
};

const SceneKeys<SleepSpec> sleep_keys{
    {"enabled", flag(&SleepSpec::enabled),
     "islands at rest are frozen until something comes near: **not exact** "
     "([method.md](../theory/method.md)); needs gravity. The section is in `scene.toml` only "
     "where "
     "given; "
     "a deposit never sleeps"},
    {"velocity", number(&SleepSpec::velocity, positive, "g h"),
     "a body whose speed + spin · circumradius is at most this counts as at rest"},
    {"steps", whole(&SleepSpec::steps, 1),
     "for so many steps all bodies of an island must have been at rest"},
};

const SceneKeys<CorrectionSpec> correction_keys{
    {"enabled", flag(&CorrectionSpec::enabled),
     "moves overlapping bodies apart, velocities untouched"},
    {"slop", number(&CorrectionSpec::slop, not_negative, "m"), "overlap left alone"},
    {"fraction", number(&CorrectionSpec::fraction, part_of_one),
     "of the overlap beyond the slop that is removed per step"},
    {"sweeps", whole(&CorrectionSpec::sweeps, 1), "Gauss–Seidel sweeps of the correction"},
};

const SceneKeys<DetectionSettings> detection_keys{
    {"max_points", whole(&DetectionSettings::max_points, 1), "contact points per pair of bodies"},
    {"skin", number(&DetectionSettings::skin, not_negative, "m"),
     "margin of the broad phase; 0: chosen from the shapes"},
    {"use_cache", flag(&DetectionSettings::use_cache),
     "start from the last step's separating axes; the contacts are the same without"},
};

const SceneKeys<RecordSpec> record_keys{
    {"pose_rate", number(&RecordSpec::pose_rate, positive, "1/s"),
     "stored poses per simulated second"},
    {"state_rate", number(&RecordSpec::state_rate, not_negative, "1/s"),
     "whole states, with contacts and impulses, kept per simulated second in `states/` "
     "([records.md](records.md)); 0: none"},
    {"checkpoint_seconds", number(&RecordSpec::checkpoint_seconds, positive, "s"),
     "wall clock between checkpoints"},
    {"paraview", flag(&RecordSpec::paraview), "`.vtp` and `.pvd` beside the record"},
    {"forces", flag(&RecordSpec::forces),
     "the contacts of every stored frame, with their forces, in `record.h5`: several times as "
     "much as the poses",
     Presence::only_where_given},
};

const SceneKeys<GrainsText> grains_keys{
    {"count", whole(&GrainsText::count, 1, 1'000'000), "grains in the box", Presence::required},
    {"seed", seed(&GrainsText::seed), "of shapes, sizes, places and orientations"},
    {"density", number(&GrainsText::density, positive, "kg/m^3"), "of the grains' material"},
    {"size", choice(&GrainsText::size, {"radius", "diameter"}),
     "how `distribution.size` is read: largest distance from the centre of mass to a vertex "
     "(\"radius\"), or twice that (\"diameter\")"},
    {"meshes", texts(&GrainsText::meshes),
     "OBJ or STL files, used in turn instead of generated shapes (their convex hulls, scaled to "
     "the sizes); relative to the scene file"},
};

const SceneKeys<SizeClass> distribution_keys{
    {"size", number(&SizeClass::size, positive, "m"), "of one class; see `grains.size`",
     Presence::required, "the paper's three classes: 0.025, 0.0375, 0.05"},
    {"fraction", number(&SizeClass::fraction, part_of_one, "by number"),
     "the fractions of `[[grains.distribution]]` sum to 1", Presence::required, "0.50, 0.34, 0.16"},
};

const SceneKeys<GrainShapeSettings> grain_shape_keys{
    {"min_vertices", whole(&GrainShapeSettings::min_vertices, 4, 200), "of the generated hulls"},
    {"max_vertices", whole(&GrainShapeSettings::max_vertices, 4, 200), "at least `min_vertices`"},
    {"elongation_min", number(&GrainShapeSettings::elongation_min, axis_ratio),
     "intermediate / longest axis"},
    {"elongation_max", number(&GrainShapeSettings::elongation_max, axis_ratio),
     "at least `elongation_min`"},
    {"flatness_min", number(&GrainShapeSettings::flatness_min, axis_ratio),
     "shortest / longest axis"},
    {"flatness_max", number(&GrainShapeSettings::flatness_max, axis_ratio),
     "at least `flatness_min`"},
    {"roughness", number(&GrainShapeSettings::roughness, roughness_range),
     "relative standard deviation of the vertex radii"},
};

const SceneKeys<BoxSpec> box_keys{
    {"length", number(&BoxSpec::length, positive, "m"),
     "along x, the driven direction; at least the largest grain's width", Presence::required},
    {"width", number(&BoxSpec::width, positive, "m"), "along y; at least the largest grain's width",
     Presence::required},
    {"friction_horizontal", number(&BoxSpec::friction_horizontal, friction_range),
     "μ at floor and lid"},
    {"friction_vertical", number(&BoxSpec::friction_vertical, friction_range),
     "μ at the side walls"},
};

const SceneKeys<DepositSpec> deposit_keys{
    {"step", number(&DepositSpec::step, positive, "s"), "h until the lid is raised"},
    {"friction", number(&DepositSpec::friction, friction_range),
     "between grains and at floor and lid until the drive begins"},
    {"fill_fraction", number(&DepositSpec::fill_fraction, fill_range, "of the bounding spheres"),
     "in the rain: its height follows"},
    {"max_time", number(&DepositSpec::max_time, positive, "s"),
     "a rain that is not at rest by then is an error"},
    {"rest_velocity", number(&DepositSpec::rest_velocity, positive, "m/s"),
     "rms velocity of the grains that counts as rest"},
    {"lid_pressure_weight",
     number(&DepositSpec::lid_pressure_weight, not_negative, "grain weights"),
     "load on the lid while it presses; 0: it is only placed"},
    {"lid_time", number(&DepositSpec::lid_time, not_negative, "s"), "how long it presses"},
    {"settle_time", number(&DepositSpec::settle_time, not_negative, "s"),
     "rest under the raised lid"},
    {"settle_step", number(&DepositSpec::settle_step, positive, "s"), "h of that rest"},
    {"gravity", number(&DepositSpec::gravity, not_negative, "m/s^2"),
     "until the drive begins; 0: `gravity.magnitude`. Given, one packing serves drives under "
     "several g"},
    {"solver", text(&DepositSpec::solver),
     "of the deposit: the drive's solver, step and friction don't enter, so all drives can start "
     "from one packing"},
    {"tolerance", number(&DepositSpec::tolerance, not_negative, "g h"), "of that solver"},
    {"max_iterations", whole(&DepositSpec::max_iterations, 1), "of that solver"},
};

const SceneKeys<DriveSpec> drive_keys{
    {"frequency", number(&DriveSpec::frequency, positive, "Hz"), "ν"},
    {"f_max_over_weight", number(&DriveSpec::f_max_over_weight, not_negative, "grain weights"),
     "largest force on the wall, in weights of all grains"},
    {"f_min_over_weight", number(&DriveSpec::f_min_over_weight, not_negative, "grain weights"),
     "smallest, at most the largest"},
    {"wall_mass_over_grains", number(&DriveSpec::wall_mass_over_grains, positive, "grain masses"),
     "the wall's mass in masses of all grains"},
    {"lid_raise", number(&DriveSpec::lid_raise, not_negative, "m"), "gap that the lid leaves"},
    {"start_noise", number(&DriveSpec::start_noise, not_negative, "m"),
     "the centres of the grains start the drive moved by up to this along each axis, drawn evenly: "
     "1e-12 makes replicas, whose differences are chaos alone",
     Presence::only_where_given},
    {"start_noise_seed", seed(&DriveSpec::start_noise_seed), "of that", Presence::only_where_given},
};

const SceneKeys<ControlVolumeSpec> control_volume_keys{
    {"margin_x", number(&ControlVolumeSpec::margin_x, not_negative, "m"),
     "where the solid fraction is taken: a box at rest this far from both walls x, clear of the "
     "driven wall's motion"},
    {"margin_y", number(&ControlVolumeSpec::margin_y, not_negative, "m"), "from both walls y"},
    {"margin_floor", number(&ControlVolumeSpec::margin_floor, not_negative, "m"), "from the floor"},
    {"margin_top", number(&ControlVolumeSpec::margin_top, not_negative, "m"),
     "below the packing's top before the drive"},
};
}  // namespace ballast
