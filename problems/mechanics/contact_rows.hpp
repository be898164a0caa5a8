#pragma once
// The numbers of H for eight contacts side by side.

#include "geometry/shape/pose.hpp"

namespace ballast {

/// The numbers of contact k are in place k of every array. Side 0 is body a, side 1 body b; rows
/// are along the normal and the two tangents. A side's rotation and arm serve its spin alone and
/// may hold any finite number where it has none.
struct ContactRows {
  static constexpr int size = 8;

  // input
  alignas(64) double normal[3][size];  ///< unit, from a to b, world frame
  double rotation[2][3][3][size];      ///< R_WB, row by row
  double arm[2][3][size];              ///< from the body's centre to the contact, world frame [m]
  // output
  double tangent[2][3][size];  ///< T1 and T2, world frame
  /// Entries of H in each row: `line` for a velocity along x, y, z, `turn` for a spin about each of
  /// the body's axes [m]. Body a has a minus, since u = velocity of b - velocity of a; `line` is
  /// that of b.
  double line[3][3][size];
  double turn[2][3][3][size];
};

void find_rows(ContactRows& block);

}  // namespace ballast
