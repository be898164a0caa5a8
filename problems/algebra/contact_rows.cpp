#include "problems/algebra/contact_rows.hpp"

#include <cstring>

#include "platform/for_each_cpu.hpp"
#include "problems/algebra/delassus.hpp"

namespace ballast {
namespace {

/// The three rows of a column of H side by side; the fourth place holds anything.
using Rows = double __attribute__((vector_size(32)));

/// What one contact adds up, column by column of its two blocks.
struct RowSums {
  Rows q, u;
  Rows squares = {};  // nn, tt, ss
  Rows mixed = {};    // tn, st, sn
};

/// Three rows on two rigid bodies whose mass is diagonal. The last contact's rows end with H, and a
/// column of four would not.
bool is_usual(const FrictionProblem& problem, const std::vector<MassRoot>& roots, int c) {
  const DynamicsForm& dynamics = problem.dynamics;
  const auto is_grain = [&](int body) {
    return body < 0 || (roots[body].diagonal && roots[body].dofs == MassRoot::max_dofs);
  };
  return problem.contact_rows(c) == 3 && is_grain(dynamics.body_a[c]) &&
         is_grain(dynamics.body_b[c]) && dynamics.h_begin[c + 1] < dynamics.h_begin.back();
}

/// In every row the operations of one contact's functions in their order. Always inline: a vector
/// wider than the processor's is then no argument of a call.
[[gnu::always_inline]] inline void add_side(const double* block, const double* v_free,
                                            const double* v, const double* inverse, RowSums& sums) {
#pragma GCC unroll 6
  for (int k = 0; k < MassRoot::max_dofs; ++k) {
    Rows column;
    std::memcpy(&column, block + 3 * k, sizeof column);
    sums.q += column * v_free[k];
    sums.u += column * v[k];
    // G = H L^-T, and W_cc = G G^T: each row with itself, and with the row after it.
    const Rows g = column * inverse[k];
    sums.squares += g * g;
    sums.mixed += g * __builtin_shufflevector(g, g, 1, 2, 0, 3);
  }
}

BALLAST_FOR_EACH_CPU void look_at_usual(const FrictionProblem& problem, const MassRoot* roots,
                                        const double* v, int c, double* q, double* u,
                                        JudgeBlock& to, int k) {
  const DynamicsForm& dynamics = problem.dynamics;
  const double* bias = dynamics.bias.data() + problem.row_begin[c];
  RowSums sums;
  sums.q = sums.u = Rows{bias[0], bias[1], bias[2], 0.0};
  const double* block = dynamics.h.data() + dynamics.h_begin[c];
  for (const int body : {dynamics.body_a[c], dynamics.body_b[c]}) {
    if (body < 0) continue;
    const int first = dynamics.dof_begin[body];
    add_side(block, dynamics.v_free.data() + first, v + first, roots[body].inverse, sums);
    block += 3 * MassRoot::max_dofs;
  }
  for (int i = 0; i < 3; ++i) {
    q[i] = sums.q[i];
    u[i] = sums.u[i];
  }
  to.nn[k] = sums.squares[0];
  to.tt[k] = sums.squares[1];
  to.ss[k] = sums.squares[2];
  to.tn[k] = sums.mixed[0];
  to.st[k] = sums.mixed[1];
  to.sn[k] = sums.mixed[2];
}

}  // namespace

void look_at_rows(const FrictionProblem& problem, const std::vector<MassRoot>& roots,
                  const Eigen::VectorXd& v, int begin, int end, Eigen::VectorXd& q,
                  Eigen::VectorXd& u, JudgeBlock& block) {
  const DynamicsForm& dynamics = problem.dynamics;
  for (int c = begin; c < end; ++c) {
    const int first = problem.row_begin[c];
    if (is_usual(problem, roots, c)) {
      look_at_usual(problem, roots.data(), v.data(), c, q.data() + first, u.data() + first, block,
                    c - begin);
      continue;
    }
    body_to_contact_velocity(dynamics, problem.row_begin, dynamics.v_free, c, c + 1, q);
    body_to_contact_velocity(dynamics, problem.row_begin, v, c, c + 1, u);
    block.take(c - begin, delassus_block(problem, roots, c));
  }
}

}  // namespace ballast
