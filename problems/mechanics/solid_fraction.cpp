#include "problems/mechanics/solid_fraction.hpp"

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

double ControlVolume::solid_fraction(const MechanicalSystem& system, const MotionState& state) {
  // Grains' volumes within the box over the box's own; where grains overlap both are counted.
  double solid = 0.0;
  for (int b = 0; b < system.grain_count; ++b) {
    const RigidBody& body = system.bodies[b];
    solid += clipper_.volume(*body.shape.polyhedron, state.pose[b], lo_, hi_, body.volume);
  }
  return solid / volume();
}

}  // namespace ballast
