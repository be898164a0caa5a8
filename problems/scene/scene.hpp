#pragma once
// A scene: everything a run depends on, as plain data. Read from TOML by scene_file, turned into
// bodies by mechanical_system.

#include <array>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/contact/contact_point.hpp"
#include "geometry/shape/compound.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "platform/error.hpp"

namespace ballast {

// Imposed motion of walls and bodies: given as a function of time, not computed.

/// rate t + amplitude (1 - cos 2 pi nu t) + the value of a table, linear between its rows, which
/// are sorted by time [s], and constant before the first and after the last. Zero at rest; without
/// a table also at t = 0. `Value`: double or Vec3.
template <class Value>
struct TimeFunction {
  Value rate, amplitude;
  double frequency = 0.0;  ///< nu [Hz]
  std::vector<std::pair<double, Value>> table = {};

  Value at(double t) const;
  /// The derivative; at a row of the table, that of the piece after the row.
  Value rate_at(double t) const;
};

/// A body is shifted, and turned about an axis that is shifted with it.
struct ImposedMotion {
  TimeFunction<Vec3> shift{Vec3::Zero(), Vec3::Zero()};  ///< [m], world frame
  Vec3 axis = Vec3::UnitZ();                             ///< unit, world frame
  Vec3 centre = Vec3::Zero();                            ///< a point of the axis at t = 0 [m]
  TimeFunction<double> turn{0.0, 0.0};                   ///< about the axis, right-handed [rad]

  /// The pose at t of a body that is at `start` when shift and turn are zero.
  Pose pose_at(double t, const Pose& start) const;
  /// The velocity of the body's point that is at `place` at t, world frame [m/s].
  Vec3 velocity_at(double t, const Vec3& place) const;
  /// Angular velocity, world frame [rad/s].
  Vec3 spin_at(double t) const { return turn.rate_at(t) * axis; }
};

/// f(t) = (f_max + f_min)/2 - (f_max - f_min)/2 sin(2 pi nu t): compressive force on a driven wall
/// [N] (paper, Eq. 1).
struct HarmonicLoad {
  double f_min = 0.0, f_max = 0.0;  ///< [N]
  double frequency = 0.0;           ///< nu [Hz]
  double at(double t) const {
    return 0.5 * (f_max + f_min) -
           0.5 * (f_max - f_min) * std::sin(2.0 * std::numbers::pi * frequency * t);
  }
};

/// How a wall moves. `driven`: one unknown, its velocity along -normal (outward), pushed along
/// +normal by the load.
enum class WallMotion { fixed, prescribed, driven };

/// The half-space boundary {x : normal.x = offset}; normal points into the free side.
struct WallSpec {
  std::string name;
  Vec3 normal = Vec3::UnitZ();
  double offset = 0.0;    ///< [m] at t = 0
  double friction = 0.0;  ///< mu of contacts with this wall
  WallMotion motion = WallMotion::fixed;
  double mass = 0.0;                                  ///< driven: [kg]
  HarmonicLoad load = {};                             ///< driven
  std::shared_ptr<const ImposedMotion> imposed = {};  ///< prescribed; it does not turn
  int material = -1;                                  ///< number in Scene::materials; -1: none
};

/// f(t) = constant + amplitude cos(2 pi nu t + phase): a force on a body's centre of mass, world
/// frame [N].
struct ForceSpec {
  Vec3 constant = Vec3::Zero();
  Vec3 amplitude = Vec3::Zero();
  double frequency = 0.0, phase = 0.0;  ///< nu [Hz]; [rad]
  Vec3 at(double t) const {
    return constant + amplitude * std::cos(2.0 * std::numbers::pi * frequency * t + phase);
  }
};

/// One rigid body, given by its shape in the principal frame.
struct BodySpec {
  std::string name;
  std::shared_ptr<const Polyhedron> shape;  ///< principal frame [m]; the hull of the parts
  std::vector<PlacedShape> parts;           ///< principal frame; empty: the shape is the body
  double mass = 0.0;                        ///< [kg]
  Vec3 inertia = Vec3::Zero();              ///< principal moments [kg m^2]
  std::string mesh_key;                     ///< of the mesh file's content; empty without one
  Pose pose;                                ///< of the principal frame
  Vec3 velocity = Vec3::Zero();             ///< world frame [m/s]
  Vec3 spin = Vec3::Zero();                 ///< angular velocity, body frame [rad/s]
  ForceSpec force;
  std::array<bool, 3> free{true, true, true};  ///< translations along the world axes
  bool free_rotation = true;                   ///< all three rotations or none
  std::optional<ImposedMotion> imposed;        ///< the body follows it and has no freedom
  int material = -1;                           ///< number in Scene::materials; -1: none

  bool can_move() const { return free[0] || free[1] || free[2] || free_rotation; }
};

/// The law of contacts between bodies of two materials.
struct MaterialPair {
  int a, b;  ///< numbers in Scene::materials
  double friction, restitution;
};

/// A crowd of generated (or scanned) grains to be deposited in the box.
struct GrainsSpec {
  int count = 0;
  std::uint64_t seed = 1;
  double density = 2700.0;  ///< [kg/m^3]
  SizeConvention size_convention = SizeConvention::radius;
  std::vector<SizeClass> distribution;
  GrainShapeSettings shape;
  /// The user's own grains, hulls of what was in the files when the scene was read; used in turn
  /// instead of generated ones, scaled to the sizes.
  std::vector<Polyhedron> meshes;
};

/// The box the grains are in: walls x_min, x_max, y_min, y_max, floor, lid. z up.
struct BoxSpec {
  double length = 0.0;               ///< along x, the driven direction [m]
  double width = 0.0;                ///< along y [m]
  double friction_horizontal = 0.4;  ///< floor and lid
  double friction_vertical = 0.0;    ///< side walls
};

/// How the packing is made before the drive.
struct DepositSpec {
  double step = 5e-4;           ///< h while depositing [s]
  double friction = 0.4;        ///< grain-grain and horizontal walls while depositing
  double fill_fraction = 0.30;  ///< of the bounding spheres in the initial rain: its height follows
  double max_time = 3.0;        ///< [s] give up waiting for rest after this
  double rest_velocity = 0.01;  ///< rms grain velocity that counts as rest [m/s]
  double lid_pressure_weight = 1.0;  ///< on the lid, in grain weights; 0: it is only placed
  double lid_time = 0.3;             ///< how long it presses [s]
  double settle_time = 0.1;          ///< rest after the lid is raised [s]
  double settle_step = 2e-4;         ///< h of that rest [s]
  /// Magnitude while depositing [m/s^2]; 0: the scene's. One packing then serves drives under
  /// several g, and under several solvers, since the deposit has its own.
  double gravity = 0.0;
  std::string solver = "nncg";
  double tolerance = 1e-2;  ///< natural map rms, in g h
  int max_iterations = 200;
  /// Above 1: one of so many tiles of the box, with its part of the grains, is deposited, and the
  /// box is copies of it.
  int tiles_x = 1, tiles_y = 1;
  int tiles() const { return tiles_x * tiles_y; }
};

/// The harmonic drive of wall x_max.
struct DriveSpec {
  double frequency = 5.0;          ///< nu [Hz]
  double f_max_over_weight = 3.0;  ///< f_max / (m g), m the total grain mass
  double f_min_over_weight = 0.0;
  double wall_mass_over_grains = 0.5;  ///< m_w / m
  double lid_raise = 0.01;             ///< [m]
  /// Every grain's centre is moved by up to this along each axis [m]: runs that differ in nothing
  /// else show the floor of chaos.
  double start_noise = 0.0;
  std::uint64_t start_noise_seed = 1;
};

/// The paper's box is the default: it is known how it moves with these numbers. Other scenes begin
/// with others: scene_file.cpp.
struct SolverSpec {
  std::string name = "nesterov_pgs";
  double tolerance = 1e-3;  ///< natural map rms, in g h (in m/s where there is no gravity)
  int max_iterations = 200;
  double max_seconds = 1e30;  ///< per step: breaks reproducibility, so off
  bool warm_start = true;
  double change_tolerance = 0.0;  ///< above 0: LMGC90's rule in place of the tolerance, looked at
  int change_every = 500;         ///< every so many iterations (solvers/parts/local_change.hpp)
  int threads = 1;  ///< set by the program, never by the file: results do not depend on it
};

/// Overlap correction by displacements only: grains are moved apart without changing velocities;
/// driven walls stay.
struct CorrectionSpec {
  bool enabled = true;
  double slop = 1e-6;     ///< overlap that is left alone [m]
  double fraction = 0.2;  ///< of the overlap beyond the slop removed per step
  int sweeps = 4;
};

struct RecordSpec {
  double pose_rate = 100.0;        ///< poses stored per simulated second
  double state_rate = 0.0;         ///< whole states (contacts, impulses) kept per simulated second
  double checkpoint_seconds = 20;  ///< wall clock between checkpoints
  bool forces = false;             ///< contact forces in the record, at pose_rate
};

/// Where the solid fraction of the vibrated box is taken: a box at rest inside the cell, under the
/// initial gap, this far from the walls and from the top of the packing [m]. It must stay clear of
/// the driven wall.
struct ControlVolumeSpec {
  double margin_x = 0.08, margin_y = 0.0, margin_floor = 0.0, margin_top = 0.0;
};

struct Scene {
  std::string name, title;
  double step = 2e-4;                ///< h [s]
  double duration = 1.0;             ///< of the driven (or only) phase [s]
  Vec3 gravity = Vec3(0, 0, -9.81);  ///< world frame [m/s^2]
  double friction = 0.4;             ///< between bodies
  double restitution = 0.0;
  Period period;  ///< of the world; zero: it does not repeat itself
  std::vector<std::string> materials;
  std::vector<MaterialPair> material_pairs;  ///< others have the friction of wall or scene
  std::vector<WallSpec> walls;
  std::vector<BodySpec> bodies;
  /// With it: box, deposit and drive hold, and walls and bodies must be empty.
  std::optional<GrainsSpec> grains;
  BoxSpec box;
  DepositSpec deposit;
  DriveSpec drive;
  SolverSpec solver;
  CorrectionSpec correction;
  DetectionSettings detection;
  RecordSpec record;
  ControlVolumeSpec control_volume;

  long step_count() const { return std::lround(duration / step); }
};

}  // namespace ballast
