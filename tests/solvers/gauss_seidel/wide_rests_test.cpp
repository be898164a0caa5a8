// Groups of open contacts that are passed over between two looks.

#include <vector>

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "tests/catch.hpp"
#include "tests/solvers/gauss_seidel/grain_problem.hpp"
#include "tests/solvers/gauss_seidel/single_sweep.hpp"

using namespace ballast;
using samples::grain_problem;
using samples::SingleSweep;

namespace {

/// A row of bodies, the first of which runs at 1 m/s into the second, which rests against the third
/// and so on; the last one has a gap before it. The first share their speed out until that gap has
/// to close. Contacts are numbered from the row's end, so that each sweep takes the push one body
/// further. Beside them other contacts that are solved by the first sweep: some closed, most open.
struct RowOfBodies {
  static constexpr int bodies = 9, closed = 249, open = 8000;
  static constexpr int gap =
      bodies - 2 + closed;  ///< the contact with the gap: groups before it are full
  FrictionProblem problem;

  RowOfBodies() {
    problem.has_dynamics = true;
    DynamicsForm& d = problem.dynamics;
    for (int b = 0; b < bodies + closed + open; ++b) {
      const Eigen::MatrixXd mass = Eigen::MatrixXd::Identity(6, 6);
      d.mass.insert(d.mass.end(), mass.data(), mass.data() + mass.size());
      d.mass_begin.push_back(static_cast<int>(d.mass.size()));
      d.dof_begin.push_back(d.dof_begin.back() + 6);
    }
    std::vector<double> bias;
    const auto add = [&](int a, int b, double opening) {
      d.body_a.push_back(a);
      d.body_b.push_back(b);
      for (const double sign : {-1.0, 1.0}) {
        if ((sign < 0.0 ? a : b) < 0) continue;
        Eigen::Matrix<double, 3, 6> rows = Eigen::Matrix<double, 3, 6>::Zero();
        rows.leftCols<3>().setIdentity();
        rows *= sign;
        d.h.insert(d.h.end(), rows.data(), rows.data() + rows.size());
      }
      d.h_begin.push_back(static_cast<int>(d.h.size()));
      problem.row_begin.push_back(problem.row_begin.back() + 3);
      problem.friction.push_back(0.5);
      bias.insert(bias.end(), {opening, 0.0, 0.0});
    };
    for (int b = bodies - 3; b >= 0; --b) add(b, b + 1, 0.0);
    for (int k = 0; k < closed; ++k) add(-1, bodies + k, -1e-3);
    add(bodies - 2, bodies - 1, 0.1);
    for (int k = 0; k < open; ++k) add(-1, bodies + closed + k, 1.0);
    d.bias = Eigen::VectorXd::Map(bias.data(), static_cast<Eigen::Index>(bias.size()));
    d.v_free.setZero(d.dof_count());
    d.v_free[0] = 1.0;
  }
};

}  // namespace

TEST_CASE("single: open contacts that rest change no bit") {
  FrictionProblem problem = grain_problem({.grains = 1200, .contacts = 5000, .seed = 9});
  // A third of them have gaps.
  Random random(9);
  for (int c = 0; c < problem.contact_count(); ++c)
    if (random.below(3) == 0)
      problem.dynamics.bias[problem.row_begin[c]] = random.uniform(0.0, 9.0);
  for (const int threads : {1, 2}) {
    SingleSweep rests(problem, true, group_kernels(), threads), all(problem, true);
    all.wide.allow_rests(false);
    for (SingleSweep* sweep : {&rests, &all}) sweep->wide.start_search();
    int resting = 0;
    for (int k = 0; k < 120; ++k) {
      const SearchStep step{k < 2 ? 0.0 : 0.5, k < 1 ? 0.0 : 1.0, k < 9 ? 0.0 : 0.4};
      const double square = all.wide.sweep(step);
      REQUIRE(rests.wide.sweep(step) == square);
      if (k % 12 != 5) continue;
      const double error = all.wide.error();
      REQUIRE(rests.wide.error() == error);
      resting = std::max(resting, rests.wide.resting_groups());
      CHECK(all.wide.resting_groups() == 0);
    }
    CHECK(resting > 40);  // of some 400
    Impulses r, expected;
    rests.wide.store(problem, r);
    all.wide.store(problem, expected);
    CHECK(r == expected);
  }
}

TEST_CASE("single: a contact that has to close while it rests is seen by the next look") {
  const RowOfBodies row;
  const int at_gap = row.problem.row_begin[RowOfBodies::gap];
  SingleSweep sweep(row.problem, true), all(row.problem, true);
  all.wide.allow_rests(false);
  Impulses r;
  const auto impulse = [&](SingleSweep& of) {
    of.wide.error();
    of.wide.store(row.problem, r);
    return r[at_gap];
  };
  for (SingleSweep* of : {&sweep, &all}) {
    of->wide.sweep();
    CHECK(impulse(*of) == 0.0);
  }
  CHECK(sweep.wide.resting_groups() > RowOfBodies::open / group_lanes - 2);
  for (int k = 0; k < 100; ++k)
    for (SingleSweep* of : {&sweep, &all}) of->wide.sweep();
  CHECK(impulse(all) > 0.01);
  CHECK(impulse(sweep) == 0.0);  // it rested
  for (int k = 0; k < 200; ++k) sweep.wide.sweep();
  CHECK(impulse(sweep) == Approx(0.125 - 0.1).epsilon(0.2));
  CHECK(contact_error(row.problem, r).natural_map_rms < 1e-6);
}
