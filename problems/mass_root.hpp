#pragma once
// The Cholesky factor of one body's mass block, M = L L^T: in the variables L^T v every body has the unit mass.

#include <cmath>

namespace ballast {

/// At most 6 x 6, on the stack. Masses are usually diagonal; then every operation is a scaling.
struct MassRoot {
  static constexpr int max_dofs = 6;

  int dofs = 0;
  bool diagonal = true;
  double l[max_dofs * max_dofs];  ///< column-major, lower triangle; only its diagonal is set when `diagonal`
  double inverse[max_dofs];       ///< 1 / L_ii

  /// `mass` is dofs x dofs, column-major; its lower triangle is read. False: not positive definite.
  bool factor(const double* mass, int dof_count);

  void solve_lower(double* x) const;     ///< x := L^-1 x
  void solve_upper(double* x) const;     ///< x := L^-T x
  void multiply_upper(double* x) const;  ///< x := L^T x
};

inline bool MassRoot::factor(const double* mass, int dof_count) {
  dofs = dof_count;
  diagonal = true;
  for (int j = 0; j < dofs; ++j)
    for (int i = j + 1; i < dofs; ++i) diagonal = diagonal && mass[j * dofs + i] == 0.0;
  for (int j = 0; j < dofs; ++j) {
    double pivot = mass[j * dofs + j];
    if (!diagonal)
      for (int k = 0; k < j; ++k) pivot -= l[k * dofs + j] * l[k * dofs + j];
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    const double root = std::sqrt(pivot);
    l[j * dofs + j] = root;
    inverse[j] = 1.0 / root;
    if (diagonal) continue;
    for (int i = j + 1; i < dofs; ++i) {
      double entry = mass[j * dofs + i];
      for (int k = 0; k < j; ++k) entry -= l[k * dofs + i] * l[k * dofs + j];
      l[j * dofs + i] = entry * inverse[j];
    }
  }
  return true;
}

inline void MassRoot::solve_lower(double* x) const {
  for (int j = 0; j < dofs; ++j) {
    x[j] *= inverse[j];
    if (!diagonal)
      for (int i = j + 1; i < dofs; ++i) x[i] -= l[j * dofs + i] * x[j];
  }
}

inline void MassRoot::solve_upper(double* x) const {
  for (int j = dofs - 1; j >= 0; --j) {
    if (!diagonal)
      for (int i = j + 1; i < dofs; ++i) x[j] -= l[j * dofs + i] * x[i];
    x[j] *= inverse[j];
  }
}

inline void MassRoot::multiply_upper(double* x) const {
  for (int j = 0; j < dofs; ++j) {
    x[j] *= l[j * dofs + j];
    if (!diagonal)
      for (int i = j + 1; i < dofs; ++i) x[j] += l[j * dofs + i] * x[i];
  }
}

}  // namespace ballast
