#include "problems/algebra/delassus.hpp"

namespace ballast {
namespace {

using SideRows = Eigen::Matrix<double, 3, MassRoot::max_dofs>;

/// G = H L^-T for one side of one contact: W = G G^T summed over the sides. Unused rows and columns
/// are zero.
SideRows mass_scaled_rows(const double* block, int rows, const MassRoot& root) {
  SideRows g = SideRows::Zero();
  if (rows == 3)
    root.scaled_columns<3>(
        block, [&](int k, const double* column) { g.col(k) << column[0], column[1], column[2]; });
  else
    root.scaled_columns<1>(block, [&](int k, const double* column) { g(0, k) = column[0]; });
  return g;
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

/// W = H M^-1 H^T = G G^T with G = H L^-T: the block of two contacts is the sum of G_c G_d^T over
/// the bodies that both of them touch.
SparseRows assemble(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  std::vector<MassRoot> roots;
  factor_masses(dynamics, roots);
  struct Side {
    int contact;
    SideRows g;
  };
  std::vector<std::vector<Side>> sides_of_body(dynamics.body_count());
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int rows = problem.contact_rows(c);
    const double* block = dynamics.h.data() + dynamics.h_begin[c];
    for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
      if (body < 0) continue;
      sides_of_body[body].push_back({c, mass_scaled_rows(block, rows, roots[body])});
      block += rows * roots[body].dofs;
    }
  }
  // Contacts that share two bodies give the same entry twice; setFromTriplets adds them.
  std::vector<Eigen::Triplet<double>> entries;
  for (const std::vector<Side>& sides : sides_of_body)
    for (const Side& side : sides)
      for (const Side& other : sides) {
        const Eigen::Matrix3d block = side.g * other.g.transpose();
        for (int i = 0; i < problem.contact_rows(side.contact); ++i)
          for (int j = 0; j < problem.contact_rows(other.contact); ++j)
            entries.emplace_back(problem.row_begin[side.contact] + i,
                                 problem.row_begin[other.contact] + j, block(i, j));
      }
  SparseRows w(problem.row_count(), problem.row_count());
  w.setFromTriplets(entries.begin(), entries.end());
  return w;
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
