#pragma once
// Do the grains roll? Their displacements over whole periods of the load (stroboscopic: the same
// phase, so that what goes to and fro drops out), and how these go around a loop in the xz plane
// (paper, Fig. 6).
//
// A mean vorticity cannot tell a roll from shear: both have a circulation. A roll goes round: along
// all four sides of a rectangle the displacement has the same sense.

#include <array>
#include <span>
#include <vector>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/wall_cycles.hpp"
#include "experiments/record/record_file.hpp"

namespace ballast {

/// What one grain has done.
struct Displacement {
  Vec3 place;  ///< of its centre, at the middle of its way [m]
  Vec3 move;   ///< [m]
};
/// Of the first `grains` bodies over the periods that count, where a frame is stored at both ends
/// (to a step of `h` [s]).
std::vector<Displacement> period_displacements(std::span<const MotionState> frames,
                                               std::span<const WallPeriod> periods, double h,
                                               size_t grains);

/// A rectangle in the xz plane; y is averaged over.
struct XzRectangle {
  double x_lo, x_hi, z_lo, z_hi;  ///< [m]
};

/// The sense of the motion along the sides of a rectangle, positive clockwise with x to the right
/// (the driven wall) and z upwards: right along the top, down the right side, left along the
/// bottom, up the left side.
struct Roll {
  /// Mean displacement along top, right, bottom, left [m].
  std::array<double, 4> along{not_known, not_known, not_known, not_known};
  double circulation = not_known;  ///< its integral around the rectangle [m^2]
  /// The weakest side over the strongest, in the sense of the circulation: 1 all sides alike,
  /// negative where a side goes against it and the grains do not go round.
  double roundness() const;
};
/// Grains within `reach` of a side count for it: about a grain's size [m]. A side without a grain
/// makes all of it not known.
Roll roll_of(std::span<const Displacement> displacements, const XzRectangle& rectangle,
             double reach);

/// Mean displacement on a grid over the rectangle, for a picture: places are the middles of the
/// cells, row by row from the lowest; cells without grains are left out.
std::vector<Displacement> cell_means(std::span<const Displacement> displacements,
                                     const XzRectangle& rectangle, int columns, int rows);

}  // namespace ballast
