#pragma once
// What the judge asks of each contact, for a block of contacts side by side.

#include <Eigen/Core>

namespace ballast {

/// So many contacts, number k of each in place k of every array.
struct JudgeBlock {
  static constexpr int size = 64;

  // What is given. Contacts of one row have zeros in the other rows; a place without a contact may
  // hold anything.
  alignas(64) double r[3][size];        ///< [N s]
  double u[3][size], q[3][size];        ///< [m/s]
  double nn[size], tn[size], sn[size];  ///< W_cc [1/kg]
  double tt[size], st[size], ss[size];
  double mu[size];

  /// W_cc into place k, by its lower triangle.
  void take(int k, const Eigen::Matrix3d& w) {
    nn[k] = w(0, 0);
    tn[k] = w(1, 0);
    sn[k] = w(2, 0);
    tt[k] = w(1, 1);
    st[k] = w(2, 1);
    ss[k] = w(2, 2);
  }

  // What is found.
  double lambda[size];      ///< largest eigenvalue of W_cc [1/kg]
  double scaled_map[size];  ///< scaled natural map [m/s]; says nothing where lambda = 0
  double map_square[size];  ///< square of the natural map with rho = 1
  double impulse[size];     ///< |r| [N s]
  double needed[size];      ///< |q| / lambda [N s]; 0 where lambda = 0
  double approach[size];    ///< max(0, -u_N) [m/s]
  double outside[size];     ///< |r - P_K(r)| [N s]
  double work[size];        ///< |r . (u + mu|u_T|n)| [J]
  double unbalanced[size];  ///< the same as a velocity [m/s]
};

/// Finds all that is to be found, in every place, with the operations of the functions for one
/// contact (friction_cone.hpp) in their order: the same bits.
void measure(JudgeBlock& block);

/// Largest eigenvalue of a symmetric block by its lower triangle, in closed form: 1/rho of the
/// scaled natural map.
///
/// Smith 1961: with B = (W - mean I) / spread, spread^2 = |W - mean I|^2 / 6, the eigenvalues of B
/// are 2 cos(...), the largest 1 + 2 s w where s^2 = (1 + det B / 2) / 2 and w in [1/2, 1/sqrt(3)]
/// is the root of w^2 (3 + 2 s w) = 1. That equation is well conditioned for every s in [0, 1]:
/// from a cubic fit (error 6e-5) two Newton steps reach rounding, without an arc cosine. Where the
/// two largest eigenvalues coincide (s = 0) the determinant's own rounding leaves 1e-8, relative:
/// enough for a scale.
double largest_eigenvalue(const Eigen::Matrix3d& w);

}  // namespace ballast
