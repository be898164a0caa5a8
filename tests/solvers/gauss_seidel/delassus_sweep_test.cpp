#include "solvers/gauss_seidel/delassus_sweep.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

TEST_CASE("sweeps on the stored W are those of dense matrices, contact after contact") {
  const FrictionProblem dynamics = make_known_solution({.bodies = 20, .contacts = 18}).problem;
  const FrictionProblem problem = only_delassus(dynamics);
  DelassusSweep sweep;
  sweep.prepare(problem);
  check_beside_slow_sweep(sweep, problem, dynamics, in_order(problem));
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
