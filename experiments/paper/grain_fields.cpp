#include "experiments/paper/grain_fields.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace ballast {
namespace {

bool is_between_grains(const MechanicalSystem& system, const PairForce& pair) {
  return pair.body_a < system.grain_count && pair.body_b < system.grain_count;
}

/// Number of force-carrying contacts of each grain, contacts of grains that are `out` not counted.
std::vector<int> contact_counts(const MechanicalSystem& system, std::span<const PairForce> pairs,
                                const std::vector<bool>& out) {
  std::vector<int> counts(static_cast<size_t>(system.grain_count), 0);
  const auto is_grain = [&](int body) { return body < system.grain_count; };
  for (const PairForce& pair : pairs) {
    const bool gone = (is_grain(pair.body_a) && out[static_cast<size_t>(pair.body_a)]) ||
                      (is_grain(pair.body_b) && out[static_cast<size_t>(pair.body_b)]);
    if (gone) continue;
    for (const int body : {pair.body_a, pair.body_b})
      if (is_grain(body)) ++counts[static_cast<size_t>(body)];
  }
  return counts;
}

/// Coordination with all grains, and without those that carry nothing.
void count_contacts(const MechanicalSystem& system, std::span<const PairForce> pairs,
                    PackingStatistics& result) {
  const auto total = [](const std::vector<int>& counts) {
    double sum = 0.0;
    for (const int count : counts) sum += count;
    return sum;
  };
  const size_t grains = static_cast<size_t>(system.grain_count);
  std::vector<bool> out(grains, false);
  // Z = (2 C_gg + C_gw) / N: a contact between two grains counts at both of them.
  std::vector<int> counts = contact_counts(system, pairs, out);
  result.coordination = total(counts) / static_cast<double>(grains);
  // Rattlers are peeled off: a grain that loses its neighbours may become one in the next round.
  size_t removed = 0;
  for (bool found = true; found;) {
    found = false;
    for (size_t k = 0; k < grains; ++k)
      if (!out[k] && counts[k] < 2) {
        out[k] = found = true;
        ++removed;
      }
    if (found) counts = contact_counts(system, pairs, out);
  }
  if (removed < grains) {
    double sum = 0.0;
    for (size_t k = 0; k < grains; ++k)
      if (!out[k]) sum += counts[k];
    result.coordination_backbone = sum / static_cast<double>(grains - removed);
  }
  result.rattlers = static_cast<double>(removed) / static_cast<double>(grains);
}

/// Means over contacts between grains of n n, f_n n n and f n, the latter two over the mean f_n:
/// the tensors F, X and Y of the header.
struct Fabric {
  Mat3 contact = Mat3::Zero(), normal = Mat3::Zero(), full = Mat3::Zero();
  double contacts = 0.0, force = 0.0;
};

Fabric fabric_of(const MechanicalSystem& system, std::span<const PairForce> pairs) {
  Fabric sum;
  for (const PairForce& pair : pairs) {
    if (!is_between_grains(system, pair)) continue;
    const Mat3 nn = pair.normal * pair.normal.transpose();
    sum.contact += nn;
    sum.normal += pair.normal_force() * nn;
    sum.full += pair.force * pair.normal.transpose();
    sum.contacts += 1.0;
    sum.force += pair.normal_force();
  }
  if (sum.contacts > 0.0) sum.contact /= sum.contacts;
  if (sum.force > 0.0) {
    sum.normal /= sum.force;
    sum.full /= sum.force;
  }
  return sum;
}

void find_anisotropy(const MechanicalSystem& system, const MotionState& state,
                     std::span<const PairForce> pairs, PackingStatistics& result) {
  // e1 and e3: along which the stress is largest and smallest
  const Principal stress =
      principal_of(stress_tensor(system, state, pairs, box_volume(system, state)));
  const Vec3 e1 = stress.direction.col(0), e3 = stress.direction.col(2);
  const auto contrast = [&](const Mat3& tensor) {
    return 2.5 * (e1.dot(tensor * e1) - e3.dot(tensor * e3));
  };
  const Fabric fabric = fabric_of(system, pairs);
  // each tensor holds the anisotropies of those before it, which are taken off
  result.fabric = contrast(fabric.contact);
  result.normal = contrast(fabric.normal) - result.fabric;
  result.tangential = contrast(fabric.full) - contrast(fabric.normal);
  // q/p is about 2/5 (a_c + a_n + a_t): the stress-force-fabric relation of
  // Rothenburg and Bathurst, 1989.
  result.shear_ratio = (stress.value[0] - stress.value[2]) / stress.value.sum();
  result.shear_from_anisotropy = 0.4 * (result.fabric + result.normal + result.tangential);
}

}  // namespace

std::vector<PairForce> pair_forces(std::span<const ContactPoint> contacts,
                                   std::span<const Vec3> impulses, double h) {
  if (contacts.size() != impulses.size())
    throw std::invalid_argument("pair forces need as many impulses as contacts");
  std::vector<PairForce> pairs;
  for (size_t k = 0; k < contacts.size();) {
    const ContactPoint& first = contacts[k];
    // the points of one pair stand together: contacts are sorted by (a, b)
    PairForce pair{first.body_a, first.body_b, first.normal, Vec3::Zero(), Vec3::Zero()};
    double weight = 0.0;
    for (; k < contacts.size() && contacts[k].body_a == first.body_a &&
           contacts[k].body_b == first.body_b;
         ++k) {
      const Vec3 force = impulses[k] / h;
      const double normal = std::max(0.0, force.dot(contacts[k].normal));
      pair.force += force;
      pair.position += normal * contacts[k].position;
      weight += normal;
    }
    if (!(weight > 0.0)) continue;  // no compression: no contact of the field
    pair.position /= weight;
    pairs.push_back(pair);
  }
  return pairs;
}

Mat3 stress_tensor(const MechanicalSystem& system, const MotionState& state,
                   std::span<const PairForce> pairs, double volume) {
  Mat3 sum = Mat3::Zero();
  // a wall has no centre: its branch vector ends at the contact
  const auto place = [&](int body, const Vec3& contact) -> Vec3 {
    return body < system.grain_count ? state.pose[static_cast<size_t>(body)].position : contact;
  };
  // The Love-Weber formula: force times branch vector, from the centre of a to that of b.
  for (const PairForce& pair : pairs)
    sum += pair.force *
           (place(pair.body_b, pair.position) - place(pair.body_a, pair.position)).transpose();
  return 0.5 * (sum + sum.transpose()) / volume;
}

Principal principal_of(const Mat3& symmetric) {
  // Eigen sorts from the smallest on, the paper from the largest
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric);
  Principal result;
  for (int k = 0; k < 3; ++k) {
    result.value[k] = solver.eigenvalues()[2 - k];
    result.direction.col(k) = solver.eigenvectors().col(2 - k);
  }
  return result;
}

double major_inclination(const Mat3& tensor) {
  // Mohr's circle: the direction of the larger principal value within the plane
  const double angle = 0.5 * std::atan2(tensor(0, 2) + tensor(2, 0),
                                        tensor(0, 0) - tensor(2, 2));  // in (-90, 90] degrees
  return std::abs(angle) * 180.0 / std::numbers::pi;
}

Mat3 velocity_gradient(const MechanicalSystem& system, const MotionState& state) {
  // places and velocities about the grains' centre of mass and its velocity
  Vec3 centre = Vec3::Zero(), drift = Vec3::Zero();
  double mass = 0.0;
  for (size_t k = 0; k < static_cast<size_t>(system.grain_count); ++k) {
    centre += system.bodies[k].mass * state.pose[k].position;
    drift += system.bodies[k].mass * state.velocity[k];
    mass += system.bodies[k].mass;
  }
  centre /= mass;
  drift /= mass;
  // the normal equations of the weighted least squares: L = (sum m v x^T) (sum m x x^T)^-1
  Mat3 moment = Mat3::Zero(), spread = Mat3::Zero();
  for (size_t k = 0; k < static_cast<size_t>(system.grain_count); ++k) {
    const Vec3 x = state.pose[k].position - centre, v = state.velocity[k] - drift;
    moment += system.bodies[k].mass * v * x.transpose();
    spread += system.bodies[k].mass * x * x.transpose();
  }
  return moment * spread.inverse();
}

double vorticity_xz(const Mat3& gradient) { return gradient(0, 2) - gradient(2, 0); }

Vec3 wall_place(const MechanicalSystem& system, const MotionState& state, BoxWall wall) {
  return state.pose[static_cast<size_t>(system.grain_count) + static_cast<size_t>(wall)].position;
}

double box_volume(const MechanicalSystem& system, const MotionState& state) {
  const auto wall = [&](BoxWall which) { return wall_place(system, state, which); };
  return (wall(wall_x_max).x() - wall(wall_x_min).x()) *
         (wall(wall_y_max).y() - wall(wall_y_min).y()) *
         (wall(wall_lid).z() - wall(wall_floor).z());
}

PackingStatistics packing_statistics(const MechanicalSystem& system, const MotionState& state,
                                     std::span<const ContactPoint> contacts,
                                     std::span<const Vec3> impulses, double h) {
  PackingStatistics result;
  const std::vector<PairForce> pairs = pair_forces(contacts, impulses, h);
  count_contacts(system, pairs, result);
  // points of contact between grains that carry force
  double between = 0.0, points = 0.0, sliding = 0.0, force = 0.0, weak = 0.0;
  for (size_t k = 0; k < contacts.size(); ++k) {
    const bool grains =
        contacts[k].body_a < system.grain_count && contacts[k].body_b < system.grain_count;
    if (grains && impulses[k].dot(contacts[k].normal) > 0.0) points += 1.0;
  }
  // pairs of grains: their forces, and which of them slide
  for (const PairForce& pair : pairs) {
    if (!is_between_grains(system, pair)) continue;
    between += 1.0;
    force += pair.normal_force();
    // Coulomb's bound; what the force has besides its normal part is friction.
    const double bound = system.pair_friction(pair.body_a, pair.body_b) * pair.normal_force();
    if ((pair.force - pair.normal_force() * pair.normal).norm() >= 0.99 * bound) sliding += 1.0;
  }
  if (between > 0.0) {
    result.mean_force = force / between;
    for (const double relative : relative_normal_forces(system, pairs))
      weak += relative < 1.0 ? 1.0 : 0.0;
    result.weak_share = weak / between;
    result.sliding_share = sliding / between;
    result.points_per_contact = points / between;
  }
  find_anisotropy(system, state, pairs, result);
  return result;
}

std::vector<double> relative_normal_forces(const MechanicalSystem& system,
                                           std::span<const PairForce> pairs) {
  std::vector<double> forces;
  double sum = 0.0;
  for (const PairForce& pair : pairs)
    if (is_between_grains(system, pair)) {
      forces.push_back(pair.normal_force());
      sum += forces.back();
    }
  for (double& force : forces) force *= static_cast<double>(forces.size()) / sum;
  return forces;
}

}  // namespace ballast
