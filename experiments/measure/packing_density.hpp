#pragma once
// The solid fraction of a packing, counted in several ways: what "rho = 0.50" means depends on
// which space and which grains are counted.

#include <array>

#include "experiments/measure/curve_fit.hpp"
#include "problems/mechanics/solid_fraction.hpp"

namespace ballast {

struct SolidFractions {
  double as_run = not_known;        ///< in the run's control volume, grains cut at its faces
  double with_walls = not_known;    ///< from wall to wall: with the loose layers beside them
  double inner = not_known;         ///< a margin from all side walls, floor and top
  double by_centres = not_known;    ///< grains whose centre is in the run's volume, whole
  double whole_grains = not_known;  ///< grains that are wholly in it
  double without_top = not_known;   ///< the run's volume without its uppermost tenth
};

/// `volume`: the run's; `wall`: the box from wall to wall and from the floor to the volume's top;
/// `margin` of the inner volume [m]. What would be empty is not known.
SolidFractions solid_fractions(const MechanicalSystem& system, const MotionState& state,
                               const ControlVolume& volume, const ControlVolume& walls,
                               double margin);

/// The solid fraction of equal horizontal layers of a volume, lowest first.
inline constexpr int density_layers = 4;
using LayerFractions = std::array<double, density_layers>;
LayerFractions layer_fractions(const MechanicalSystem& system, const MotionState& state,
                               const ControlVolume& volume);

}  // namespace ballast
