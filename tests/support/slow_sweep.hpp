#pragma once
// The simple twin of every Gauss-Seidel sweep: dense matrices, one contact after the other.

#include <numeric>
#include <vector>

#include "problems/algebra/delassus.hpp"
#include "problems/algebra/friction_problem.hpp"
#include "solvers/gauss_seidel/sweep_plan.hpp"
#include "solvers/parts/one_contact.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

namespace ballast {

/// An order with the same result as a sweep over bodies, if no wall is driven.
inline std::vector<int> plan_order(const FrictionProblem& problem) {
  SweepPlan plan;
  plan.prepare(problem);
  return plan.contacts();
}

/// The contacts in their own order.
inline std::vector<int> in_order(const FrictionProblem& problem) {
  std::vector<int> contacts(static_cast<size_t>(problem.contact_count()));
  std::iota(contacts.begin(), contacts.end(), 0);
  return contacts;
}

/// One sweep in the given order, which solves each contact by itself against all others. `w`, `q`:
/// the dense W and q of the whole problem.
template <class Order>
void slow_sweep(const FrictionProblem& problem, const Eigen::MatrixXd& w, const Eigen::VectorXd& q,
                const Order& order, Impulses& r) {
  for (const int c : order) {
    const int begin = problem.row_begin[c], rows = problem.contact_rows(c);
    Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
    block.topLeftCorner(rows, rows) = w.block(begin, begin, rows, rows);
    Eigen::Vector3d others = Eigen::Vector3d::Zero(), own = Eigen::Vector3d::Zero();
    own.head(rows) = r.segment(begin, rows);
    others.head(rows) = w.middleRows(begin, rows) * r + q.segment(begin, rows);
    others -= block * own;
    double slip = 0.0;
    solve_one_contact(block, others, problem.friction[c], own, slip);
    r.segment(begin, rows) = own.head(rows);
  }
}

/// |change|^2 of impulses in the coordinates of a sweep. Over bodies y = r_N + c . r_T replaces
/// r_N; in groups the coordinates are scaled so that W_NN = s1 = 1.
inline double swept_square(const FrictionProblem& problem, const Impulses& change,
                           bool in_groups = false) {
  if (!problem.has_dynamics) return change.squaredNorm();
  std::vector<Eigen::Matrix3d> blocks;
  delassus_diagonal(problem, blocks);
  double sum = 0.0;
  for (int c = 0; c < problem.contact_count(); ++c) {
    PrincipalContact local;
    TangentTurn turn;
    make_principal(blocks[c], 0.0, local, turn);
    const int rows = problem.contact_rows(c);
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    d.head(rows) = change.segment(problem.row_begin[c], rows);
    turn.to_principal(d[1], d[2]);
    d[0] += local.c1 * d[1] + local.c2 * d[2];
    sum += in_groups ? d[0] * d[0] / local.inverse_normal + local.s1 * d.tail<2>().squaredNorm()
                     : d.squaredNorm();
  }
  return sum;
}

}  // namespace ballast
