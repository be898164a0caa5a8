// The pass over all rows against the functions for one number after the other.

#include "problems/algebra/contact_rows.hpp"

#include <algorithm>
#include <memory>

#include "platform/random.hpp"
#include "problems/algebra/delassus.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/pile_problems.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"

using namespace ballast;

namespace {

/// Grains with diagonal masses, as a time step has them.
FrictionProblem pile() {
  PileSettings settings;
  settings.contacts = 300;
  settings.mass_ratio = 50.0;
  return make_pile(settings);
}

}  // namespace

TEST_CASE("one pass over the rows gives the bits of one contact after another") {
  Random random(41);
  int grains = 0, others = 0;
  for (const FrictionProblem& problem :
       {pile(), oracle::mixed_problem(), make_known_solution({}).problem}) {
    std::vector<MassRoot> roots;
    factor_masses(problem.dynamics, roots);
    Eigen::VectorXd v(problem.dynamics.dof_count());
    for (double& x : v) x = random.uniform(-1, 1);
    Eigen::VectorXd free, moved, q(problem.row_count()), u(problem.row_count());
    free_contact_velocity(problem, free);
    body_to_contact_velocity(problem.dynamics, problem.row_begin, v, moved);
    const auto block = std::make_unique<JudgeBlock>();
    for (int begin = 0; begin < problem.contact_count(); begin += 37) {
      const int end = std::min(begin + 37, problem.contact_count());
      look_at_rows(problem, roots, v, begin, end, q, u, *block);
      for (int c = begin; c < end; ++c) {
        const int k = c - begin;
        const Eigen::Matrix3d w = delassus_block(problem, roots, c);
        REQUIRE(block->nn[k] == w(0, 0));
        REQUIRE(block->tn[k] == w(1, 0));
        REQUIRE(block->sn[k] == w(2, 0));
        REQUIRE(block->tt[k] == w(1, 1));
        REQUIRE(block->st[k] == w(2, 1));
        REQUIRE(block->ss[k] == w(2, 2));
        bool diagonal = problem.contact_rows(c) == 3;
        for (const int body : {problem.dynamics.body_a[c], problem.dynamics.body_b[c]})
          if (body >= 0) diagonal = diagonal && roots[body].diagonal && roots[body].dofs == 6;
        (diagonal ? grains : others) += 1;
      }
    }
    REQUIRE(q == free);
    REQUIRE(u == moved);
  }
  CHECK(grains > 200);
  CHECK(others > 5);
}
