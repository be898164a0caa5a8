#include "problems/mechanics/solid_fraction.hpp"

#include <algorithm>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace ballast {

ControlVolume::ControlVolume(const Vec3& lo, const Vec3& hi) : lo_(lo), hi_(hi) {
  if ((lo.array() < hi.array()).all()) return;
  std::ostringstream message;
  message << "control volume: the margins leave nothing: from (" << lo.transpose() << ") to ("
          << hi.transpose() << ") m";
  throw std::invalid_argument(message.str());
}

double ControlVolume::solid_fraction(const MechanicalSystem& system, const MotionState& state,
                                     WorkerTeam* team) {
  // Grains that stand on the box's faces take nearly all the time and lie side by side: small parts
  // share them out.
  constexpr int parts_of_thread = 8;
  const int parts = size_of(team) == 1 ? 1 : parts_of_thread * size_of(team);
  clippers_.resize(std::max(clippers_.size(), static_cast<size_t>(parts)));
  inside_.resize(static_cast<size_t>(system.grain_count));
  run_parts(team, parts, [&](int part) {
    const long grains = system.grain_count, begin = grains * part / parts,
               end = grains * (part + 1) / parts;
    for (long b = begin; b < end; ++b) {
      const RigidBody& body = system.bodies[b];
      inside_[b] =
          clippers_[part].volume(*body.shape.polyhedron, state.pose[b], lo_, hi_, body.volume);
    }
  });
  // Grains' volumes within the box over the box's own; where grains overlap both are counted. One
  // after the other, whoever clipped them: the same bits.
  return std::accumulate(inside_.begin(), inside_.end(), 0.0) / volume();
}

}  // namespace ballast
