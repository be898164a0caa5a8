#pragma once
// What one state of a packing says: forces between bodies, stress, velocity gradient, coordination,
// fabric and force anisotropy, with the definitions of the field (Radjai, Delenne, Azema, Roux
// 2012; Azema, Radjai, Dubois 2013).

#include <span>
#include <vector>

#include "experiments/box/vibrated_box.hpp"
#include "experiments/record/checkpoint.hpp"
#include "problems/mechanics/mechanical_system.hpp"

namespace ballast {

/// All contact points of two bodies together: one contact of the field. Forces in newtons, world
/// frame.
struct PairForce {
  int body_a, body_b;
  Vec3 normal;    ///< unit, from a to b
  Vec3 position;  ///< of the points, weighted by their normal forces [m]
  Vec3 force;     ///< on b [N]
  double normal_force() const { return force.dot(normal); }  ///< > 0: compressive
};

/// Contacts must be sorted by (a, b), as detection gives them. Pairs without a compressive force
/// are left out. h: step of the impulses [s].
std::vector<PairForce> pair_forces(std::span<const ContactPoint> contacts,
                                   std::span<const Vec3> impulses, double h);

/// sigma = 1/V sum f l^T over contacts, f on b by a, l from a's centre to b's (from the contact
/// point where a is a wall); symmetric part. Compression is positive. volume [m^3]; [Pa].
Mat3 stress_tensor(const MechanicalSystem& system, const MotionState& state,
                   std::span<const PairForce> pairs, double volume);

/// Principal values, largest first, with their directions as columns.
struct Principal {
  Vec3 value;
  Mat3 direction;
};
Principal principal_of(const Mat3& symmetric);

/// Angle of the major principal direction within the xz plane to the horizontal, 0 to 90 degrees.
double major_inclination(const Mat3& tensor);

/// v = v0 + L (x - x0), least squares over grains weighted by mass: the mean velocity gradient L
/// [1/s].
Mat3 velocity_gradient(const MechanicalSystem& system, const MotionState& state);
/// Mean vorticity of the xz plane, dv_x/dz - dv_z/dx [1/s]: positive is clockwise when x points
/// right and z up.
double vorticity_xz(const Mat3& gradient);

/// A point of one of the box's walls, where `state` has it [m].
Vec3 wall_place(const MechanicalSystem& system, const MotionState& state, BoxWall wall);
/// Volume between the box's walls [m^3]; `state` places them.
double box_volume(const MechanicalSystem& system, const MotionState& state);

struct PackingStatistics {
  double coordination =
      0.0;  ///< Z = (2 grain-grain + grain-wall contacts that carry force) / grains
  double coordination_backbone = 0.0;  ///< the same without grains of fewer than two such contacts,
                                       ///< found again until none is left
  double rattlers = 0.0;               ///< share of the grains so left out
  double points_per_contact = 0.0;  ///< contact points that carry force per grain-grain contact: 1
                                    ///< corner, 2 edge, 3 and more face
  double mean_force = 0.0;          ///< normal, grain-grain [N]
  double weak_share = 0.0;          ///< of contacts with less than the mean force
  double sliding_share = 0.0;       ///< of contacts at 99 % of Coulomb's bound
  double fabric = 0.0;              ///< a_c
  double normal = 0.0;              ///< a_n
  double tangential = 0.0;          ///< a_t
  double shear_ratio = 0.0;         ///< q/p = (s1 - s3)/(s1 + s2 + s3)
  double shear_from_anisotropy =
      0.0;  ///< 2/5 (a_c + a_n + a_t), which the field expects to be near q/p
};

/// Anisotropies along the major and minor stress directions e1, e3: a_c = 5/2 (F11 - F33), F = <n
/// n>; a_n = 5/2 (X11 - X33) - a_c, X = sum f_n n n / sum f_n; a_t = 5/2 (Y11 - Y33) - a_c - a_n, Y
/// = sum f n / sum f_n. Grain-grain contacts.
PackingStatistics packing_statistics(const MechanicalSystem& system, const MotionState& state,
                                     std::span<const ContactPoint> contacts,
                                     std::span<const Vec3> impulses, double h);

/// Normal forces of grain-grain contacts over their mean.
std::vector<double> relative_normal_forces(const MechanicalSystem& system,
                                           std::span<const PairForce> pairs);

}  // namespace ballast
