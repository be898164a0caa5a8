// The rule of LMGC90 against its dense twin, and a backend that it stops.

#include "solvers/parts/local_change.hpp"

#include <numeric>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

namespace {

/// The norms as LMGC90 sums them: velocities u = W r + q by a dense product, each contact solved
/// against all others, each sum by itself.
ChangeNorms slow_norms(const FrictionProblem& problem, const Impulses& r) {
  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  const Eigen::VectorXd q = oracle::dense_q(problem), u = w * r + q;
  std::vector<double> d2, m2, wr2, e, md;
  for (int c = 0; c < problem.contact_count(); ++c) {
    Impulses alone = r;
    slow_sweep(problem, w, q, std::vector<int>{c}, alone);
    const int begin = problem.row_begin[c], rows = problem.contact_rows(c);
    const Eigen::MatrixXd block = w.block(begin, begin, rows, rows);
    const Eigen::VectorXd old = r.segment(begin, rows), now = alone.segment(begin, rows);
    const Eigen::VectorXd free = u.segment(begin, rows) - block * old;
    const Eigen::VectorXd d = u.segment(begin, rows) - (block * now + free);
    const Eigen::VectorXd m = (old + now) / 2.0;
    if (m.norm() == 0.0 || block.norm() == 0.0) continue;  // has no impulse, or cannot move
    d2.push_back(d.squaredNorm());
    m2.push_back(m.squaredNorm());
    md.push_back(m.dot(d));
    wr2.push_back(((block * old).squaredNorm() + (block * now).squaredNorm()) / 2.0);
    e.push_back((old.dot(block * old) + now.dot(block * now)) / 2.0);
  }
  const auto mean = [](const std::vector<double>& x) {
    return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
  };
  ChangeNorms norms;
  std::vector<double> dm2;
  for (size_t k = 0; k < d2.size(); ++k) dm2.push_back(d2[k] * m2[k]);
  norms.velocity_mean = std::sqrt(mean(d2)) / std::sqrt(mean(wr2));
  norms.velocity_max = std::sqrt(*std::max_element(d2.begin(), d2.end()) / mean(wr2));
  norms.energy_mean = std::sqrt(mean(dm2)) / mean(e);
  norms.energy_max = std::sqrt(*std::max_element(dm2.begin(), dm2.end())) / mean(e);
  norms.drift = mean(md) / mean(e);
  return norms;
}

void check_equal(const ChangeNorms& a, const ChangeNorms& b, double margin) {
  for (const auto member :
       {&ChangeNorms::velocity_mean, &ChangeNorms::velocity_max, &ChangeNorms::energy_mean,
        &ChangeNorms::energy_max, &ChangeNorms::drift})
    CHECK(a.*member == Approx(b.*member).epsilon(1e-9).margin(margin));
}

ChangeNorms norms_at(const FrictionProblem& problem, const Impulses& r) {
  ContactOperator w;
  w.prepare(problem);
  return local_change(w, r);
}

const KnownSolution known = make_known_solution({.contacts = 80});

}  // namespace

TEST_CASE("the norms of a local change are those of a dense twin, in both forms of a problem") {
  for (const FrictionProblem& problem : {oracle::mixed_problem(), known.problem}) {
    Impulses r(problem.row_count());
    for (int i = 0; i < r.size(); ++i) r[i] = std::sin(1.7 * i) + (i % 3 == 0 ? 0.5 : 0.0);
    const ChangeNorms slow = slow_norms(problem, r);
    CHECK(slow.velocity_mean > 0.01);
    check_equal(norms_at(problem, r), slow, 0.0);
    check_equal(norms_at(only_delassus(problem), r), slow, 0.0);
  }
}

TEST_CASE("at a solution nothing changes, and in twice as heavy and fast units all is the same") {
  check_equal(norms_at(known.problem, known.r), {}, 1e-9);
  FrictionProblem other = known.problem;
  for (double& entry : other.dynamics.mass) entry *= 4.0;
  other.dynamics.v_free *= 8.0;
  other.dynamics.bias *= 8.0;
  const Impulses r = 1.3 * known.r;
  check_equal(norms_at(other, 32.0 * r), norms_at(known.problem, r), 0.0);
  check_equal(norms_at(known.problem, 0.0 * r), slow_norms(known.problem, 0.0 * r), 0.0);
}

TEST_CASE("the largest change may be 16.666 times the mean one, the drift has either sign") {
  const ChangeNorms enough{0.9, 16.6, 0.9, 16.6, -0.9};
  CHECK(enough.within(1.0));
  CHECK(!enough.within(0.89));
  for (const auto member :
       {&ChangeNorms::velocity_mean, &ChangeNorms::energy_mean, &ChangeNorms::drift}) {
    ChangeNorms more = enough;
    more.*member *= 1.2;
    CHECK(!more.within(1.0));
  }
  for (const auto member : {&ChangeNorms::velocity_max, &ChangeNorms::energy_max}) {
    ChangeNorms more = enough;
    more.*member = 16.7;
    CHECK(!more.within(1.0));
  }
}

TEST_CASE("pgs under the rule stops where dense sweeps do that are looked at as often") {
  constexpr int every = 7;
  constexpr double tolerance = 1e-3;
  const FrictionProblem& problem = known.problem;
  // The twin: dense sweeps, and the dense norms after every seventh sweep.
  const Eigen::MatrixXd w = oracle::dense_delassus(problem);
  const Eigen::VectorXd q = oracle::dense_q(problem);
  Impulses slow = Impulses::Zero(problem.row_count());
  int sweeps = 0;
  do
    for (int k = 0; k < every; ++k, ++sweeps) slow_sweep(problem, w, q, in_order(problem), slow);
  while (!slow_norms(problem, slow).within(tolerance));
  CHECK(sweeps > 2 * every);

  const auto solver = make_change_stopped(make_solver("pgs"), {tolerance, every});
  const Budget budget{.tolerance = 1e3, .max_iterations = 100000, .keep_history = true};
  for (int again = 0; again < 2; ++again) {
    const SolverRun run = SolverRunner().run(*solver, only_delassus(problem), {}, budget);
    CHECK(run.solved.reason == StopReason::stalled);
    CHECK(run.solved.iterations == sweeps);
    CHECK((run.solved.impulses - slow).norm() <= 1e-8 * slow.norm());
    CHECK(run.solved.history.back().iteration == sweeps);
  }
}

TEST_CASE("under the rule a limit still holds, and a problem without contacts ends at once") {
  const auto solver = make_change_stopped(make_solver("nncg"), {1e-12, 50});
  Budget budget{.tolerance = 0.0, .max_iterations = 120};
  const SolverRun run = SolverRunner().run(*solver, known.problem, {}, budget);
  CHECK(run.solved.iterations == 120);
  CHECK(run.solved.reason == StopReason::iteration_limit);
  FrictionProblem empty;
  empty.has_dynamics = true;
  CHECK(SolverRunner().run(*solver, empty, {}, budget).solved.iterations == 0);
}
