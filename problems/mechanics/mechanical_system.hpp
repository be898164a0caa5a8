#pragma once
// A scene's bodies and walls as one list of rigid bodies, and their state; and the solid fraction
// of grains in a box at rest (Fig. 12 of the paper).

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/shape/clipped_volume.hpp"
#include "platform/worker_team.hpp"
#include "problems/scene/scene.hpp"

namespace ballast {

/// The unknowns of a body: translations along the first `translations` columns of `axes`
/// (orthonormal, world frame), and all rotations (about the body axes) or none. A driven wall has
/// one translation, a fixed body none.
struct Freedom {
  int translations = 3;
  Mat3 axes = Mat3::Identity();
  bool rotation = true;
  int count() const { return translations + (rotation ? 3 : 0); }
  bool operator==(const Freedom&) const = default;
};

/// The constants of one body. Grains come first, in scene order, then the walls.
struct RigidBody {
  std::string name;
  ContactShape shape;
  double mass = 0.0;            ///< [kg]; unused without freedom
  Vec3 inertia = Vec3::Zero();  ///< principal [kg m^2]
  Freedom freedom;
  double volume = 0.0;  ///< [m^3]; 0 for walls
  ForceSpec force;      ///< on bodies
  WallSpec wall;        ///< on walls: motion, load, and mu of contacts with it
  int material = -1;    ///< a number in material_laws; -1: none
  /// The imposed motion that a body or wall follows, with the pose that it starts from.
  struct Imposed {
    ImposedMotion motion;
    Pose start;
  };
  std::shared_ptr<const Imposed> imposed = {};
  bool is_wall() const { return shape.polyhedron == nullptr; }
};

/// The law of contacts between two bodies.
struct PairLaw {
  double friction, restitution;
};

/// Positions and velocities at t_k: everything that a step changes, apart from warm starts.
struct MotionState {
  double time = 0.0;  ///< [s]
  long step = 0;
  std::vector<Pose> pose;      ///< body frame in the world frame [m]
  std::vector<Vec3> velocity;  ///< centre of mass, world frame [m/s]
  std::vector<Vec3> spin;      ///< angular velocity, body frame [rad/s]
};

/// Everything that stays the same: bodies, gravity, friction, restitution. Owns the shapes.
struct MechanicalSystem {
  std::vector<RigidBody> bodies;
  std::vector<std::shared_ptr<const Polyhedron>> shapes;
  int grain_count = 0;          ///< bodies [0, grain_count) are polyhedra, the rest are walls
  Vec3 gravity = Vec3::Zero();  ///< world frame [m/s^2]
  double friction = 0.0;
  double restitution = 0.0;
  Period period;
  std::map<std::pair<int, int>, PairLaw> material_laws;  ///< the smaller number first

  double highest_restitution() const;  ///< 0: nothing rebounds anywhere
  double mass_of_grains() const;
  int first_driven_wall() const;  ///< -1 when there is none
};

/// Bodies and walls of a scene, with the initial state. For scenes with `grains` use
/// experiments/box/vibrated_box, which makes them.
MechanicalSystem make_system(const Scene& scene, MotionState& state);

/// Appends a body or a wall (walls last). Used by make_system and by the vibrated box.
void add_body(MechanicalSystem& system, MotionState& state, const BodySpec& spec, double volume);
void add_wall(MechanicalSystem& system, MotionState& state, const WallSpec& spec);

/// Sets pose, velocity and spin (body frame) of a body with imposed motion at that time [s].
void follow(const RigidBody& body, double time, Pose& pose, Vec3& velocity, Vec3& spin);

std::vector<ContactShape> contact_shapes(const MechanicalSystem& system);

/// Displacement of a wall from where it started, along -normal (outward) [m], and its outward
/// velocity [m/s].
double outward_displacement(const MechanicalSystem& system, const MotionState& state, int wall);
double outward_velocity(const MechanicalSystem& system, const MotionState& state, int wall);

/// The axis-aligned box [lo, hi], world frame [m]. Keeps buffers: one object per thread.
class ControlVolume {
 public:
  /// Throws std::invalid_argument unless lo < hi in all three directions.
  ControlVolume(const Vec3& lo, const Vec3& hi);

  /// Volume of all grains inside the box over the volume of the box, exact to rounding. Overlaps of
  /// grains count twice. A team shares the work; its size changes no bit.
  double solid_fraction(const MechanicalSystem& system, const MotionState& state,
                        WorkerTeam* team = nullptr);

  const Vec3& lo() const { return lo_; }
  const Vec3& hi() const { return hi_; }
  double volume() const { return (hi_ - lo_).prod(); }

 private:
  Vec3 lo_, hi_;
  std::vector<double> inside_;  // volume of each grain within the box [m^3]
};

}  // namespace ballast
