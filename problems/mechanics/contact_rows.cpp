// Compiled with -fno-trapping-math (problems/CMakeLists.txt): both sides of a choice are computed,
// and the loops over contacts become vector instructions. No bit depends on it.

#include "problems/mechanics/contact_rows.hpp"

#include <cmath>

#include "platform/for_each_cpu.hpp"

namespace ballast {
namespace {

struct Triple {
  double x, y, z;
};
BALLAST_IN_LOOP Triple cross(const Triple& p, const Triple& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

/// The world axis most nearly perpendicular to n, less its part along n, as a unit vector.
BALLAST_IN_LOOP Triple first_tangent(const Triple& n) {
  const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
  const bool is_z = z < x && z < y, is_y = !is_z && y < x;
  const double along = is_z ? n.z : is_y ? n.y : n.x;
  const Triple v{(is_z || is_y ? 0.0 : 1.0) - along * n.x, (is_y ? 1.0 : 0.0) - along * n.y,
                 (is_z ? 1.0 : 0.0) - along * n.z};
  const double size = std::sqrt((v.x * v.x + v.y * v.y) + v.z * v.z);
  return {v.x / size, v.y / size, v.z / size};
}

}  // namespace

// The order of all sums is that of published runs.
BALLAST_FOR_EACH_CPU void find_rows(ContactRows& block) {
  ContactRows& b = block;
  for (int k = 0; k < ContactRows::size; ++k) {
    const Triple n{b.normal[0][k], b.normal[1][k], b.normal[2][k]},
        first = first_tangent(n), frame[3] = {n, first, cross(n, first)};
    for (int t = 0; t < 2; ++t) {
      b.tangent[t][0][k] = frame[t + 1].x;
      b.tangent[t][1][k] = frame[t + 1].y;
      b.tangent[t][2][k] = frame[t + 1].z;
    }
    // Summed like products with the axes, so that zeros have the same sign.
    for (int row = 0; row < 3; ++row) {
      const Triple& f = frame[row];
      b.line[row][0][k] = f.x + (0.0 * f.y + 0.0 * f.z);
      b.line[row][1][k] = 0.0 * f.x + (f.y + 0.0 * f.z);
      b.line[row][2][k] = 0.0 * f.x + (0.0 * f.y + f.z);
    }
    // d . R (w_B x s) = w_B . (s x R^T d): lever and direction in the body frame
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? -1.0 : 1.0;
      const auto& rotation = b.rotation[side];
      const auto& arm = b.arm[side];
      double lever[3];
      for (int i = 0; i < 3; ++i)
        lever[i] = sign * ((rotation[0][i][k] * arm[0][k] + rotation[1][i][k] * arm[1][k]) +
                           rotation[2][i][k] * arm[2][k]);
      for (int row = 0; row < 3; ++row) {
        double direction[3];
        for (int i = 0; i < 3; ++i)
          direction[i] = rotation[0][i][k] * frame[row].x +
                         (rotation[1][i][k] * frame[row].y + rotation[2][i][k] * frame[row].z);
        const Triple turning =
            cross({lever[0], lever[1], lever[2]}, {direction[0], direction[1], direction[2]});
        b.turn[side][row][0][k] = turning.x;
        b.turn[side][row][1][k] = turning.y;
        b.turn[side][row][2][k] = turning.z;
      }
    }
  }
}

}  // namespace ballast
