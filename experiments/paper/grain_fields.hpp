#pragma once
// What one state of a packing says: forces between bodies, and the stress.

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

/// Angle of the major principal direction within the xz plane to the horizontal, 0 to 90 degrees.
double major_inclination(const Mat3& tensor);

/// A point of one of the box's walls, where `state` has it [m].
Vec3 wall_place(const MechanicalSystem& system, const MotionState& state, BoxWall wall);
/// Volume between the box's walls [m^3]; `state` places them.
double box_volume(const MechanicalSystem& system, const MotionState& state);

/// Normal forces of grain-grain contacts over their mean.
std::vector<double> relative_normal_forces(const MechanicalSystem& system,
                                           std::span<const PairForce> pairs);

}  // namespace ballast
