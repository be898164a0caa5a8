#pragma once
// Records for the tests of this room: contacts of two bodies with random blocks, and the same in
// dense matrices.

#include <algorithm>

#include <Eigen/Dense>

#include "platform/random.hpp"
#include "solvers/gauss_seidel/sweep_record.hpp"

namespace ballast::samples {

using Twelve = Eigen::Matrix<double, 12, 1>;
using Rows = Eigen::Matrix<double, 3, 12>;

/// A contact as prepare() meets it: its blocks for unit masses, side by side, its bias, mu.
struct Given {
  Rows h;
  Eigen::Vector3d bias;
  double mu;

  explicit Given(Random& random) : mu(random.uniform(0.0, 1.0)) {
    for (double& x : h.reshaped()) x = random.uniform(-1.0, 1.0);
    for (double& x : bias) x = random.uniform(-1.0, 1.0);
  }
  /// Bodies 0 and 1; not yet in principal coordinates.
  FrictionRecord record() const {
    FrictionRecord k{};
    for (int s = 0; s < 2; ++s)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < row_width; ++j) k.rows[s][i][j] = h(i, 6 * s + j);
    std::copy_n(bias.data(), 3, k.bias);
    k.body[1] = 1;
    return k;
  }
};

/// A contact whose bodies do not move: all rows are zero.
struct Nothing {
  FrictionRecord friction{};
};

inline Rows rows(const FrictionRecord& k) {
  Rows g;
  for (int s = 0; s < 2; ++s)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < row_width; ++j) g(i, 6 * s + j) = k.rows[s][i][j];
  return g;
}

inline Eigen::Vector3d velocity(const FrictionRecord& k, const Twelve& v) {
  return rows(k) * v + Eigen::Vector3d(k.bias[0], k.bias[1], k.bias[2]);
}

/// The velocities of bodies 0 and 1, one after the other.
inline Twelve both(const BodyVelocity* bodies) {
  Twelve v;
  for (int s = 0; s < 2; ++s)
    for (int j = 0; j < row_width; ++j) v[6 * s + j] = bodies[s].w[j];
  return v;
}

}  // namespace ballast::samples
