#include "problems/algebra/delassus.hpp"

#include <algorithm>

namespace ballast {
namespace {

/// Replaces H by G = H L^-T in the block of one side of a contact, and moves on to the next block.
template <int Rows>
void scale_columns(double*& block, const MassRoot& root) {
  root.scaled_columns<Rows>(
      block, [block](int k, const double* column) { std::copy_n(column, Rows, block + k * Rows); });
  block += Rows * root.dofs;
}

/// The lower triangle of G G^T, summed over columns and sides.
struct Gram {
  double nn = 0.0, tn = 0.0, sn = 0.0, tt = 0.0, st = 0.0, ss = 0.0;

  template <int Rows>
  [[gnu::always_inline]] inline void add_side(const double* block, const MassRoot& root) {
    root.scaled_columns<Rows>(
        block, [this](int, const double* g) __attribute__((always_inline)) {
          nn += g[0] * g[0];
          if constexpr (Rows == 3) {
            tn += g[1] * g[0];
            sn += g[2] * g[0];
            tt += g[1] * g[1];
            st += g[2] * g[1];
            ss += g[2] * g[2];
          }
        });
  }
};

/// W = H M^-1 H^T = G G^T with G = H L^-T.
SparseRows assemble(FrictionProblem problem) {
  DynamicsForm& dynamics = problem.dynamics;
  std::vector<MassRoot> roots;
  factor_masses(dynamics, roots);
  for (int c = 0; c < problem.contact_count(); ++c) {
    double* block = dynamics.h.data() + dynamics.h_begin[c];
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      if (body < 0) continue;
      if (problem.contact_rows(c) == 3)
        scale_columns<3>(block, roots[body]);
      else
        scale_columns<1>(block, roots[body]);
    }
  }
  const SparseRows g = sparse_h(problem);
  return g * SparseRows(g.transpose());
}

}  // namespace

void delassus_diagonal(const FrictionProblem& problem, std::vector<MassRoot>& roots,
                       std::vector<Eigen::Matrix3d>& blocks) {
  blocks.resize(problem.contact_count());
  if (!problem.has_dynamics) {
    for (int c = 0; c < problem.contact_count(); ++c) {
      const Eigen::Matrix3d block = stored_diagonal_block(problem, c);
      blocks[c] = 0.5 * (block + block.transpose());
    }
    return;
  }
  factor_masses(problem.dynamics, roots);
  for (int c = 0; c < problem.contact_count(); ++c) blocks[c] = delassus_block(problem, roots, c);
}

Eigen::Matrix3d delassus_block(const FrictionProblem& problem, const std::vector<MassRoot>& roots,
                               int c) {
  const DynamicsForm& dynamics = problem.dynamics;
  const int rows = problem.contact_rows(c);
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  Gram w;
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    if (body < 0) continue;
    rows == 3 ? w.add_side<3>(block, roots[body]) : w.add_side<1>(block, roots[body]);
    block += rows * roots[body].dofs;
  }
  Eigen::Matrix3d sum;
  sum << w.nn, w.tn, w.sn, w.tn, w.tt, w.st, w.sn, w.st, w.ss;
  return sum;
}

void delassus_diagonal(const FrictionProblem& problem, std::vector<Eigen::Matrix3d>& blocks) {
  std::vector<MassRoot> roots;
  delassus_diagonal(problem, roots, blocks);
}

SparseRows delassus_matrix(const FrictionProblem& problem) {
  return problem.has_delassus ? problem.delassus.w : assemble(problem);
}

}  // namespace ballast
