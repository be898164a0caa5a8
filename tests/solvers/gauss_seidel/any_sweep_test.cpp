#include "solvers/gauss_seidel/any_sweep.hpp"

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/problems/algebra/dense_oracle.hpp"
#include "tests/solvers/gauss_seidel/grain_problem.hpp"
#include "tests/support/delassus_form.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;

namespace {

std::vector<FrictionProblem> problems() {
  std::vector<FrictionProblem> all{oracle::mixed_problem()};
  for (const KnownSolutionSettings& settings : {KnownSolutionSettings{.friction_max = 0.8},
                                                {.frictionless_fraction = 0.5},
                                                {.contacts = 100, .mass_ratio = 100.0}})
    all.push_back(make_known_solution(settings).problem);
  all.push_back(all[1]);
  for (std::size_t k = 0; k < all[1].dynamics.mass.size(); ++k)
    if (k % 36 % 7 != 0) all.back().dynamics.mass[k] = 0.0;  // diagonal masses
  return all;
}

/// Compares ten sweeps in either form with those of dense matrices. `dense`: in the dynamics form.
void check_sweeps(const FrictionProblem& given, const FrictionProblem& dense) {
  const Eigen::MatrixXd w = oracle::dense_delassus(dense);
  const Eigen::VectorXd q = oracle::dense_q(dense);
  const std::vector<int> order = given.has_dynamics ? plan_order(given) : in_order(given);
  Impulses slow = Impulses::Constant(given.row_count(), 0.1), fast = slow;
  AnySweep sweep;
  sweep.prepare(given);
  sweep->load(given, fast);
  for (int k = 0; k < 10; ++k) {
    slow_sweep(dense, w, q, order, slow);
    sweep->sweep();
    sweep->store(given, fast);
    REQUIRE((fast - slow).norm() <= 1e-11 * (1.0 + slow.norm()));
    const double judged = contact_error(dense, fast).natural_map_rms;
    REQUIRE(sweep->error() == Approx(judged).epsilon(1e-6).margin(1e-13));
  }
}

}  // namespace

TEST_CASE("a sweep over bodies, and over W, is the textbook's") {
  for (const FrictionProblem& problem : problems()) {
    check_sweeps(problem, problem);
    check_sweeps(only_delassus(problem), problem);
  }
}

TEST_CASE("W by whole blocks and entry by entry gives the same bits") {
  FrictionProblem whole =
      only_delassus(make_known_solution({.frictionless_fraction = 0.0}).problem);
  // The blocks store zeros; a second W has none of them. Every block keeps its first row, which
  // gives its place among the others.
  SparseRows& w = whole.delassus.w;
  for (int row = 1; row < whole.row_count(); row += 3)
    for (SparseRows::InnerIterator entry(w, row); entry; ++entry)
      if ((row + entry.col()) % 5 == 1) entry.valueRef() = 0.0;
  FrictionProblem sparse = whole;
  sparse.delassus.w.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
  REQUIRE(sparse.delassus.w.nonZeros() < w.nonZeros());
  const auto swept = [](const FrictionProblem& problem) {
    AnySweep sweep;
    sweep.prepare(problem);
    Impulses r = Impulses::Constant(problem.row_count(), 0.1);
    sweep->load(problem, r);
    for (int k = 0; k < 3; ++k) sweep->sweep();
    sweep->store(problem, r);
    return std::pair(r, sweep->error());
  };
  CHECK(swept(sparse) == swept(whole));
}

TEST_CASE("contacts and bodies of every kind: loaded and stored alike, but for what cannot move") {
  const FrictionProblem mixed = oracle::mixed_problem();  // contact 4 cannot move
  for (const FrictionProblem& problem : {mixed, only_delassus(mixed)}) {
    AnySweep sweep;
    sweep.prepare(problem);
    const Impulses r = Impulses::LinSpaced(problem.row_count(), 0.1, 0.9);
    Impulses back = Impulses::Zero(problem.row_count()), expected = r;
    expected.segment(problem.row_begin[4], 3).setZero();
    sweep->load(problem, r);
    sweep->store(problem, back);
    CHECK((back - expected).norm() <= 1e-14 * r.norm());
    CHECK(sweep->error() == Approx(contact_error(problem, expected).natural_map_rms));
  }
}

TEST_CASE("grains are swept in groups, anything else contact by contact") {
  AnySweep sweep;
  const auto is_wide = [&](const FrictionProblem& problem) {
    sweep.prepare(problem);
    return dynamic_cast<WideSweep*>(sweep.operator->()) != nullptr;
  };
  CHECK(is_wide(samples::grain_problem()));
  CHECK_FALSE(is_wide(oracle::mixed_problem()));
}
