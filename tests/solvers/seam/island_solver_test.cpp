// A backend island by island: each island gets the bits that it has alone, and what that makes of
// the whole.

#include "solvers/seam/island_solver.hpp"

#include "problems/algebra/known_solutions.hpp"
#include "problems/algebra/stress_problems.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/fixed_contact.hpp"

using namespace ballast;

namespace {

std::unique_ptr<Solver> by_islands(const char* name) {
  return make_island_solver(make_solver(name));
}

/// Problems side by side: bodies and contacts of one after those of the other.
FrictionProblem beside(const std::vector<FrictionProblem>& problems) {
  FrictionProblem all;
  all.has_dynamics = true;
  DynamicsForm& to = all.dynamics;
  for (const FrictionProblem& problem : problems) {
    const DynamicsForm& from = problem.dynamics;
    const int bodies = to.body_count(), dofs = to.dof_count(), rows = all.row_count();
    const int masses = to.mass_begin.back(), entries = to.h_begin.back();
    for (size_t b = 1; b < from.dof_begin.size(); ++b)
      to.dof_begin.push_back(dofs + from.dof_begin[b]);
    for (size_t b = 1; b < from.mass_begin.size(); ++b)
      to.mass_begin.push_back(masses + from.mass_begin[b]);
    to.mass.insert(to.mass.end(), from.mass.begin(), from.mass.end());
    for (int c = 0; c < problem.contact_count(); ++c) {
      to.body_a.push_back(from.body_a[c] < 0 ? -1 : bodies + from.body_a[c]);
      to.body_b.push_back(from.body_b[c] < 0 ? -1 : bodies + from.body_b[c]);
      to.h_begin.push_back(entries + from.h_begin[c + 1]);
      all.row_begin.push_back(rows + problem.row_begin[c + 1]);
      all.friction.push_back(problem.friction[c]);
    }
    to.h.insert(to.h.end(), from.h.begin(), from.h.end());
    to.v_free.conservativeResize(to.dof_count());
    to.v_free.tail(from.v_free.size()) = from.v_free;
    to.bias.conservativeResize(all.row_count());
    to.bias.tail(from.bias.size()) = from.bias;
  }
  return all;
}

const FrictionProblem easy = mass_stack({1, 1, 1}, 3).problem,
                      hard = mass_stack(std::vector<double>(12, 1.0), 3).problem,
                      chain = jammed_chain(8, 50.0).problem;

}  // namespace

TEST_CASE("one island: the same bits, iterations and reason as without") {
  for (const char* name : {"nncg", "pgs", "apgd"}) {
    INFO(name);
    const Budget budget{.tolerance = 1e-6, .max_iterations = 300, .keep_history = true};
    const SolverRun plain = SolverRunner().run(*make_solver(name), hard, {}, budget);
    const SolverRun split = SolverRunner().run(*by_islands(name), hard, {}, budget);
    CHECK(split.solved.impulses == plain.solved.impulses);
    CHECK(split.solved.iterations == plain.solved.iterations);
    CHECK(split.solved.reason == plain.solved.reason);
    CHECK(split.solved.own_residual == plain.solved.own_residual);
    CHECK(split.solved.history.size() == plain.solved.history.size());
  }
}

TEST_CASE(
    "several islands: each has the bits that it has alone, and all together meet the tolerance") {
  const FrictionProblem all = beside({easy, hard, chain});
  for (const char* name : {"nncg", "pgs", "apgd"}) {
    INFO(name);
    const Budget budget{.tolerance = 1e-5, .max_iterations = 100000};
    const auto solver = by_islands(name);
    for (int again = 0; again < 2; ++again) {  // one solver for a sequence of problems
      const SolverRun run = SolverRunner().run(*solver, all, {}, budget);
      CHECK(run.is_solved());
      CHECK(run.error.natural_map_rms <= 1e-5);
      Eigen::Index row = 0;
      double visits = 0.0;
      for (const FrictionProblem* part : {&easy, &hard, &chain}) {
        const SolverRun alone = SolverRunner().run(*make_solver(name), *part, {}, budget);
        CHECK(run.solved.impulses.segment(row, part->row_count()) == alone.solved.impulses);
        CHECK(alone.error.natural_map_rms <= 1e-5);
        row += part->row_count();
        visits += alone.solved.iterations * part->contact_count();
      }
      CHECK(run.solved.iterations == std::ceil(visits / all.contact_count()));
    }
  }
}

TEST_CASE("islands are begun from their own part of the start") {
  const FrictionProblem all = beside({easy, hard});
  const Budget budget{.tolerance = 1e-6, .max_iterations = 100000};
  const SolverRun first = SolverRunner().run(*by_islands("nncg"), all, {}, budget);
  const SolverRun second =
      SolverRunner().run(*by_islands("nncg"), all, first.solved.impulses, budget);
  CHECK(first.solved.iterations > 0);
  CHECK(second.solved.iterations == 0);
  CHECK((second.solved.impulses - first.solved.impulses).norm() <=
        1e-12 * first.solved.impulses.norm());
}

TEST_CASE("the reason of several islands is the worst of theirs") {
  // easy reaches the tolerance within the limit, hard does not
  const FrictionProblem all = beside({easy, hard});
  const Budget budget{.tolerance = 1e-7, .max_iterations = 60};
  CHECK(SolverRunner().run(*make_solver("pgs"), easy, {}, budget).is_solved());
  const SolverRun run = SolverRunner().run(*by_islands("pgs"), all, {}, budget);
  CHECK(run.solved.reason == StopReason::iteration_limit);
  CHECK_FALSE(run.is_solved());
  CHECK(run.solved.iterations <= 60);
}

TEST_CASE("contacts between bodies that cannot move get no impulse") {
  FrictionProblem all = beside({easy, hard});
  add_fixed_contact(all, Eigen::VectorXd::Zero(1));
  const SolverRun run = SolverRunner().run(*by_islands("nncg"), all,
                                           Impulses::Ones(all.row_count()), {.tolerance = 1e-6});
  CHECK(run.is_solved());
  CHECK(run.solved.impulses[all.row_count() - 1] == 0.0);
}

TEST_CASE("a backend that refuses, fails or returns nothing says so through the islands") {
  class Failing final : public Solver {
   public:
    void prepare(const FrictionProblem&) override {}
    Solved solve(const FrictionProblem&, Impulses, const Budget&) override { return {}; }
  };
  const FrictionProblem all = beside({easy, chain});
  const SolverRun nothing =
      SolverRunner().run(*make_island_solver(std::make_unique<Failing>()), all, {}, {});
  CHECK(nothing.solved.reason == StopReason::numerical_failure);
  CHECK(nothing.solved.impulses.isZero(0.0));
  CHECK_FALSE(nothing.is_solved());

  FrictionProblem stored;  // W and q alone: newton_burst factorises over bodies
  stored.has_delassus = true;
  stored.row_begin.push_back(1);
  stored.friction.push_back(0.0);
  stored.delassus.w.resize(1, 1);
  stored.delassus.w.insert(0, 0) = 1.0;
  stored.delassus.q.setOnes(1);
  CHECK_THROWS_AS(SolverRunner().run(*by_islands("newton_burst"), stored, {}, {}),
                  UnsupportedProblem);
  CHECK(SolverRunner().run(*by_islands("pgs"), stored, {}, {}).is_solved());
}
