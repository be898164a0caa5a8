// Compiled with -fno-trapping-math (experiments/CMakeLists.txt), so that both sides of a choice are
// computed and the loops over bodies become vector instructions. The flag changes no bit.

#include "experiments/step/free_spin.hpp"

#include <algorithm>
#include <cmath>

#include "platform/for_each_cpu.hpp"

namespace ballast {
namespace {

/// The iteration has converged when the spin changes by at most this fraction of it.
constexpr double rounding = 1e-16;

/// Several bodies side by side: element k of every array belongs to body k of the block.
struct SpinBlock {
  static constexpr int size = 8;
  alignas(64) double inertia[3][size];   ///< principal [kg m^2]
  double spin[3][size], after[3][size];  ///< [rad/s]
  double is_found[size];                 ///< 1: `after` is the solution; 0: not yet
};

/// The fixed-point iteration of free_spin(), with the same operations in the same order.
BALLAST_FOR_EACH_CPU void find_spins(SpinBlock& block, double h) {
  constexpr int most_iterations = 12;
  SpinBlock b = block;
  double inverse[3][SpinBlock::size], enough[SpinBlock::size];
  for (int k = 0; k < SpinBlock::size; ++k) {
    for (int i = 0; i < 3; ++i) {
      inverse[i][k] = 1.0 / b.inertia[i][k];
      b.after[i][k] = b.spin[i][k];
    }
    const double x = b.spin[0][k], y = b.spin[1][k], z = b.spin[2][k];
    enough[k] = rounding * std::sqrt((x * x + y * y) + z * z);
    b.is_found[k] = 0.0;
  }
  double found = 0.0;
  for (int iteration = 0; iteration < most_iterations && found < SpinBlock::size; ++iteration) {
    for (int k = 0; k < SpinBlock::size; ++k) {
      double mean[3], momentum[3];
      for (int i = 0; i < 3; ++i) {
        mean[i] = 0.5 * (b.spin[i][k] + b.after[i][k]);
        momentum[i] = b.inertia[i][k] * mean[i];
      }
      const double turning[3] = {momentum[1] * mean[2] - momentum[2] * mean[1],
                                 momentum[2] * mean[0] - momentum[0] * mean[2],
                                 momentum[0] * mean[1] - momentum[1] * mean[0]};
      double square[3];
      const bool was_found = b.is_found[k] != 0.0;
      for (int i = 0; i < 3; ++i) {
        const double update = b.spin[i][k] + h * (inverse[i][k] * turning[i]);
        const double change = update - b.after[i][k];
        square[i] = change * change;
        b.after[i][k] = was_found ? b.after[i][k] : update;
      }
      const double change = std::sqrt((square[0] + square[1]) + square[2]);
      b.is_found[k] = was_found || change <= enough[k] ? 1.0 : 0.0;
    }
    found = 0.0;
    for (int k = 0; k < SpinBlock::size; ++k) found += b.is_found[k];
  }
  block = b;
}

}  // namespace

Vec3 free_spin(const Vec3& inertia, const Vec3& spin, double h) {
  // Fixed-point iteration for the implicit mid-point rule of Euler's equations, I dw/dt = (I w) x
  // w. The rule conserves the kinetic energy.
  const Vec3 inverse = inertia.cwiseInverse();
  Vec3 next = spin;
  double change = 0.0;
  for (int iteration = 0; iteration < 50; ++iteration) {  // contracts by ~ h |w| / 2: a few suffice
    // w' = w + h I^-1 ((I w_m) x w_m) with w_m = (w + w') / 2.
    const Vec3 mean = 0.5 * (spin + next);
    const Vec3 update = spin + h * inverse.cwiseProduct(inertia.cwiseProduct(mean).cross(mean));
    change = (update - next).norm();
    next = update;
    if (change <= rounding * spin.norm()) return next;
  }
  if (change <= 1e-10 * spin.norm()) return next;
  // The iteration diverges from h |w| ~ 2 on. Two half steps conserve energy and momentum as well.
  constexpr double most_radians = 1e3;
  if (!(h * spin.norm() < most_radians)) return Vec3::Constant(std::nan(""));
  return free_spin(inertia, free_spin(inertia, spin, 0.5 * h), 0.5 * h);
}

void free_spins(std::span<const Vec3> inertia, std::span<const Vec3> spin, double h,
                std::span<Vec3> after) {
  SpinBlock block;
  for (size_t begin = 0; begin < spin.size(); begin += SpinBlock::size) {
    const auto body = [&](size_t k) { return std::min(begin + k, spin.size() - 1); };
    for (size_t k = 0; k < SpinBlock::size; ++k)
      for (int i = 0; i < 3; ++i) {
        block.inertia[i][k] = inertia[body(k)][i];
        block.spin[i][k] = spin[body(k)][i];
      }
    find_spins(block, h);
    for (size_t k = 0; k < SpinBlock::size && begin + k < spin.size(); ++k) {
      const Vec3 found(block.after[0][k], block.after[1][k], block.after[2][k]);
      after[begin + k] =
          block.is_found[k] != 0.0 ? found : free_spin(inertia[begin + k], spin[begin + k], h);
    }
  }
}

}  // namespace ballast
