#include "solvers/gauss_seidel/delassus_sweep.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"

using namespace ballast;

namespace {

/// One sweep with dense matrices: contact after contact, solved by itself against all others.
void slow_sweep(const FrictionProblem& problem, const Eigen::MatrixXd& w, const Eigen::VectorXd& q,
                Impulses& r) {
  for (int c = 0; c < problem.contact_count(); ++c) {
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

}  // namespace

TEST_CASE("sweeps on the stored W are those of dense matrices, contact after contact") {
  const FrictionProblem dynamics = make_known_solution({.bodies = 20, .contacts = 18}).problem;
  const FrictionProblem problem = only_delassus(dynamics);
  const Eigen::MatrixXd w = oracle::dense_delassus(dynamics);
  const Eigen::VectorXd q = oracle::dense_q(dynamics);
  DelassusSweep sweep;
  sweep.prepare(problem);
  Impulses fast = Impulses::Constant(problem.row_count(), 0.01), slow = fast;
  sweep.load(problem, fast);
  for (int k = 0; k < 4; ++k) {
    sweep.sweep();
    slow_sweep(problem, w, q, slow);
    sweep.store(problem, fast);
    CHECK((fast - slow).norm() <= 1e-10 * slow.norm());
    CHECK(sweep.error() == Approx(contact_error(problem, fast).natural_map_rms).margin(1e-14));
  }
}

TEST_CASE("an iterate is saved and restored, and an impulse that moves nothing is dropped") {
  const FrictionProblem problem =
      only_delassus(oracle::mixed_problem());  // contact 4: nothing moves
  DelassusSweep sweep;
  sweep.prepare(problem);
  Impulses r = Impulses::Constant(problem.row_count(), 0.3), first, again;
  sweep.load(problem, r);
  Eigen::VectorXd state;
  sweep.save(state);
  CHECK(state.size() == 3 * problem.contact_count());
  first.setZero(problem.row_count());
  again = first;
  sweep.sweep();
  sweep.store(problem, first);
  CHECK(first.segment(problem.row_begin[4], 3) == Eigen::Vector3d::Zero());
  sweep.restore(state);
  sweep.sweep();
  sweep.store(problem, again);
  CHECK((first - again).norm() <= 1e-12 * first.norm());  // the slip roots are other first guesses
}

TEST_CASE("weights are the square roots of each block's largest eigenvalue") {
  const FrictionProblem dynamics = oracle::mixed_problem();
  const FrictionProblem problem = only_delassus(dynamics);
  DelassusSweep sweep;
  sweep.prepare(problem);
  Eigen::VectorXd weights;
  sweep.impulse_weights(weights);
  std::vector<Eigen::Matrix3d> blocks;
  delassus_diagonal(dynamics, blocks);
  for (int c = 0; c < problem.contact_count(); ++c)
    for (int i = 0; i < 3; ++i)
      CHECK(weights[3 * c + i] == Approx(std::sqrt(largest_eigenvalue(blocks[c]))));
}
