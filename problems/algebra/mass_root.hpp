#pragma once
// The Cholesky factor of one body's mass block, M = L L^T: in the variables L^T v every body has
// the unit mass.

#include <cmath>
#include <memory>

namespace ballast {

/// At most 6 x 6. Masses are usually diagonal; then every operation is a scaling, and the root is
/// one cache line.
struct alignas(64) MassRoot {
  static constexpr int max_dofs = 6;

  double inverse[max_dofs];  ///< 1 / L_ii
  int dofs = 0;
  bool diagonal = true;
  /// Unless `diagonal`: column-major, stride max_dofs, lower triangle.
  std::unique_ptr<double[]> l;

  /// `mass` is dofs x dofs, column-major; its lower triangle is read. False: not positive definite.
  bool factor(const double* mass, int dof_count);

  void solve(double* x) const;  ///< x := M^-1 x
  /// x := L^T x. `mass` is the block whose root this is.
  void multiply_upper(const double* mass, double* x) const;

  /// Calls visit(k, column) for the columns of G = H L^-T, where H is a column-major block of Rows
  /// x dofs and `column` has Rows entries. Inlined where it is hot: with the usual six unknowns
  /// known, the compiler unrolls it into registers.
  template <int Rows, typename Visit>
  [[gnu::always_inline]] inline void scaled_columns(const double* h, const Visit& visit) const {
    if (dofs == max_dofs)
      scaled_columns<Rows>(h, max_dofs, visit);
    else
      scaled_columns<Rows>(h, dofs, visit);
  }

 private:
  template <int Rows, typename Visit>
  [[gnu::always_inline]] inline void scaled_columns(const double* h, int columns,
                                                    const Visit& visit) const {
    double g[max_dofs][Rows];
    if (diagonal) {
      for (int j = 0; j < columns; ++j) {
        for (int i = 0; i < Rows; ++i) g[j][i] = h[j * Rows + i] * inverse[j];
        visit(j, g[j]);
      }
      return;
    }
#pragma GCC unroll 6
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < Rows; ++i) g[j][i] = h[j * Rows + i];
#pragma GCC unroll 6
      for (int k = 0; k < j; ++k)
        for (int i = 0; i < Rows; ++i) g[j][i] -= l[k * max_dofs + j] * g[k][i];
      for (int i = 0; i < Rows; ++i) g[j][i] *= inverse[j];
      visit(j, g[j]);
    }
  }
};

inline bool MassRoot::factor(const double* mass, int dof_count) {
  dofs = dof_count;
  diagonal = true;
  for (int j = 0; j < dofs; ++j)
    for (int i = j + 1; i < dofs; ++i) diagonal = diagonal && mass[j * dofs + i] == 0.0;
  if (!diagonal && !l) l = std::make_unique<double[]>(max_dofs * max_dofs);
  for (int j = 0; j < dofs; ++j) {
    double pivot = mass[j * dofs + j];
    if (!diagonal)
      for (int k = 0; k < j; ++k) pivot -= l[k * max_dofs + j] * l[k * max_dofs + j];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double root = std::sqrt(pivot);
    inverse[j] = 1.0 / root;
    if (diagonal) continue;
    l[j * max_dofs + j] = root;
    for (int i = j + 1; i < dofs; ++i) {
      double entry = mass[j * dofs + i];
      for (int k = 0; k < j; ++k) entry -= l[k * max_dofs + i] * l[k * max_dofs + j];
      l[j * max_dofs + i] = entry * inverse[j];
    }
  }
  return true;
}

inline void MassRoot::solve(double* x) const {
  // L^-1, then L^-T.
  for (int j = 0; j < dofs; ++j) {
    x[j] *= inverse[j];
    if (!diagonal)
      for (int i = j + 1; i < dofs; ++i) x[i] -= l[j * max_dofs + i] * x[j];
  }
  for (int j = dofs - 1; j >= 0; --j) {
    if (!diagonal)
      for (int i = j + 1; i < dofs; ++i) x[j] -= l[j * max_dofs + i] * x[i];
    x[j] *= inverse[j];
  }
}

inline void MassRoot::multiply_upper(const double* mass, double* x) const {
  for (int j = 0; j < dofs; ++j) {
    x[j] *= diagonal ? std::sqrt(mass[j * dofs + j]) : l[j * max_dofs + j];
    if (!diagonal)
      for (int i = j + 1; i < dofs; ++i) x[j] += l[j * max_dofs + i] * x[i];
  }
}

}  // namespace ballast
