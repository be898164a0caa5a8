#include "experiments/measure/packing_density.hpp"

namespace ballast {
namespace {

double fraction_in(const MechanicalSystem& system, const MotionState& state, const Vec3& lo,
                   const Vec3& hi) {
  if (!(lo.array() < hi.array()).all()) return not_known;
  return ControlVolume(lo, hi).solid_fraction(system, state);
}

/// Volumes of the grains that `counts` says, over that of the box.
template <class Counts>
double fraction_of(const MechanicalSystem& system, const ControlVolume& volume,
                   const Counts& counts) {
  double solid = 0.0;
  for (int b = 0; b < system.grain_count; ++b)
    if (counts(b)) solid += system.bodies[b].volume;
  return solid / volume.volume();
}

}  // namespace

SolidFractions solid_fractions(const MechanicalSystem& system, const MotionState& state,
                               const ControlVolume& volume, const ControlVolume& walls,
                               double margin) {
  const auto is_inside = [&](const Vec3& x) {
    return (x.array() >= volume.lo().array()).all() && (x.array() <= volume.hi().array()).all();
  };
  SolidFractions found;
  found.as_run = fraction_in(system, state, volume.lo(), volume.hi());
  found.with_walls = fraction_in(system, state, walls.lo(), walls.hi());
  found.inner = fraction_in(system, state, walls.lo() + Vec3::Constant(margin),
                            walls.hi() - Vec3::Constant(margin));
  found.by_centres =
      fraction_of(system, volume, [&](int b) { return is_inside(state.pose[b].position); });
  found.whole_grains = fraction_of(system, volume, [&](int b) {
    for (const Vec3& vertex : system.bodies[b].shape.polyhedron->vertices())
      if (!is_inside(state.pose[b] * vertex)) return false;
    return true;
  });
  Vec3 cut = volume.hi();
  cut.z() -= 0.1 * (volume.hi().z() - volume.lo().z());
  found.without_top = fraction_in(system, state, volume.lo(), cut);
  return found;
}

LayerFractions layer_fractions(const MechanicalSystem& system, const MotionState& state,
                               const ControlVolume& volume) {
  LayerFractions fractions;
  Vec3 lo = volume.lo(), hi = volume.hi();
  const double height = (hi.z() - lo.z()) / density_layers;
  for (size_t k = 0; k < fractions.size(); ++k) {
    lo.z() = volume.lo().z() + static_cast<double>(k) * height;
    hi.z() = lo.z() + height;
    fractions[k] = fraction_in(system, state, lo, hi);
  }
  return fractions;
}

}  // namespace ballast
