// The sweep in groups against dense matrices, contact after contact.

#include "solvers/gauss_seidel/wide_sweep.hpp"

#include <algorithm>

#include "problems/algebra/contact_error.hpp"
#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"
#include "tests/solvers/gauss_seidel/grain_problem.hpp"
#include "tests/support/fixed_contact.hpp"
#include "tests/support/slow_sweep.hpp"

using namespace ballast;
using samples::grain_problem;
using samples::Wide;

namespace {

constexpr double all_betas[] = {0.0, 0.0, 0.7, 0.3, 0.0, 0.9, 0.5, 0.6};

Impulses start_of(const FrictionProblem& problem) {
  return Impulses::Constant(problem.row_count(), 1e-5);
}

/// An order with the result of groups: the plan's, but in each part the contacts on the driven wall
/// come last. It holds if no grain has a second contact with the wall, which would have to wait for
/// a later group.
std::vector<int> group_order(const SweepPlan& plan, const FrictionProblem& problem) {
  const DynamicsForm& d = problem.dynamics;
  std::vector<int> order = plan.contacts();
  for (const SweepPlan::Part& part : plan.parts())
    std::stable_partition(order.begin() + part.begin, order.begin() + part.end, [&](int c) {
      return d.body_dofs(d.body_a[c]) != 1 && d.body_dofs(d.body_b[c]) != 1;
    });
  return order;
}

double difference(const Impulses& x, const Impulses& y) { return (x - y).norm() / y.norm(); }

/// Contacts whose grains have no other contact: one sweep solves each of them. The velocities cover
/// three decades.
FrictionProblem contacts_apart(std::uint64_t seed) {
  samples::GrainSettings settings{.grains = 640, .contacts = 320, .has_wall = false, .seed = seed};
  FrictionProblem problem = grain_problem(settings);
  Random random(seed);
  DynamicsForm& d = problem.dynamics;
  for (int c = 0; c < settings.contacts; ++c) {
    if (d.body_a[c] >= 0) d.body_a[c] = 2 * c;
    if (d.body_b[c] >= 0) d.body_b[c] = 2 * c + 1;
    const double size = random.log_uniform(1e-3, 1.0);
    for (int k = 12 * c; k < 12 * (c + 1); ++k) d.v_free[k] = size * random.uniform(-1.0, 1.0);
  }
  d.bias.setZero();
  for (double& mu : problem.friction) mu *= 3.0;  // so that more of them stick
  return problem;
}

}  // namespace

TEST_CASE("wide: a sweep is the textbook's in the same order, to rounding") {
  for (const double mass_ratio : {1.0, 1e6}) {
    const FrictionProblem problem = grain_problem({.mass_ratio = mass_ratio, .seed = 3});
    Wide wide(problem);
    REQUIRE(wide.fits);
    const Eigen::MatrixXd w = oracle::dense_delassus(problem);
    const Eigen::VectorXd q = oracle::dense_q(problem);
    const std::vector<int> order = group_order(wide.plan, problem);
    CHECK(static_cast<int>(order.size()) == problem.contact_count());
    Impulses fast = start_of(problem), slow = fast;
    wide.sweep.load(problem, fast);
    for (int k = 1; k <= 30; ++k) {
      wide.sweep.sweep();
      slow_sweep(problem, w, q, order, slow);
      wide.sweep.store(problem, fast);
      REQUIRE(difference(fast, slow) <= (k == 1 ? 1e-15 : 1e-12));
      const double judged = contact_error(problem, fast).natural_map_rms;
      REQUIRE(wide.sweep.error() == Approx(judged).epsilon(1e-9).margin(1e-14));
    }
  }
}

TEST_CASE("wide: every status of the law is met, and each contact solved to rounding") {
  int open = 0, stick = 0, slip = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const FrictionProblem problem = contacts_apart(seed);
    Wide wide(problem);
    REQUIRE(wide.fits);
    Impulses r = Impulses::Zero(problem.row_count());
    wide.sweep.load(problem, r);
    wide.sweep.sweep();
    wide.sweep.store(problem, r);
    CHECK(contact_error(problem, r).natural_map_max <= 1e-14);  // velocities are up to 1 m/s
    CHECK(contact_error(problem, r).cone_violation <= 1e-15 * r.norm());
    Eigen::VectorXd u;
    contact_velocity(problem, r, u);
    for (int c = 0; c < problem.contact_count(); ++c) {
      if (problem.contact_rows(c) != 3) continue;
      const Eigen::Vector3d rc = r.segment<3>(problem.row_begin[c]),
                            uc = u.segment<3>(problem.row_begin[c]);
      (rc[0] == 0.0 ? open : uc.tail<2>().norm() < 1e-12 ? stick : slip) += 1;
    }
  }
  CHECK(open > 100);
  CHECK(stick > 100);
  CHECK(slip > 100);
}

TEST_CASE("wide: the same bits on every instruction set, with any number of threads") {
  // Three slabs, so that threads have interiors and interfaces.
  const FrictionProblem problem = grain_problem({.grains = 1600, .contacts = 6000, .seed = 5});
  for (const bool single : {false, true}) {
    Impulses expected;
    std::vector<double> expected_numbers;
    for (const GroupKernels* kernels : all_group_kernels())
      for (const int threads : {1, 2, 3, 8}) {
        Wide wide(problem, single, *kernels, threads);
        REQUIRE(wide.fits);
        REQUIRE(wide.plan.slabs() >= 2);
        std::vector<double> numbers;
        for (int k = 0; k < 40; ++k) {
          if (k % 20 == 0) wide.sweep.start_search();
          numbers.push_back(wide.sweep.sweep_along(samples::varied_step(k % 20, k >= 20)));
          if (k % 5 == 4) numbers.push_back(wide.sweep.rough_error());
          if (k % 10 == 9) numbers.push_back(wide.sweep.error());
        }
        for (int k = 0; k < 5; ++k) wide.sweep.sweep();
        CHECK(wide.sweep.is_single() == single);
        numbers.push_back(wide.sweep.error());
        Impulses r;
        wide.sweep.store(problem, r);
        if (expected.size() == 0) {
          expected = r;
          expected_numbers = numbers;
        }
        INFO(kernels->instruction_set << ", single " << single << ", threads " << threads);
        CHECK(r == expected);
        CHECK(numbers == expected_numbers);
      }
  }
  CHECK(all_group_kernels().back()->instruction_set == std::string("sse2"));
}

TEST_CASE("wide: a sweep along a search moves the whole iterate by the same step, then sweeps") {
  const FrictionProblem problem = grain_problem({.seed = 8});
  for (const bool is_conjugate : {false, true}) {
    Wide fast(problem), slow(problem);
    Impulses x = start_of(problem), start = x, last = x, p = 0.0 * x, found;
    fast.sweep.load(problem, x);
    fast.sweep.start_search();
    for (const double beta : all_betas) {
      const double square = fast.sweep.sweep_along({beta, is_conjugate});
      // The twin: the formulas on the impulses, which determine the velocities.
      const Impulses move = beta * (is_conjugate ? p : x - last);
      p = move + (x - start);
      last = x;
      start = x + move;
      slow.sweep.load(problem, start);
      slow.sweep.sweep();
      slow.sweep.store(problem, x);
      CHECK(square == Approx(swept_square(problem, x - start, /*in_groups=*/true)).epsilon(1e-11));
      fast.sweep.store(problem, found);
      CHECK(difference(found, x) <= 1e-13);
    }
    CHECK(x.norm() > 0.0);
  }
}

TEST_CASE("wide: impulses that are loaded come back, what nothing moves is dropped") {
  FrictionProblem problem = grain_problem({.seed = 2});
  add_fixed_contact(problem, Eigen::Vector3d::Constant(0.1));
  Wide wide(problem);
  REQUIRE(wide.fits);
  Impulses r = Impulses::LinSpaced(problem.row_count(), 1e-6, 1e-4), back;
  wide.sweep.load(problem, r);
  wide.sweep.store(problem, back);
  CHECK(back.tail<3>() == Eigen::Vector3d::Zero());
  r.tail<3>().setZero();
  CHECK(difference(back, r) <= 1e-15);
  CHECK(wide.sweep.error() == Approx(contact_error(problem, r).natural_map_rms).epsilon(1e-12));
}

TEST_CASE("wide: says of other problems that it cannot take them") {
  const auto fits = [](const FrictionProblem& problem) { return Wide(problem).fits; };
  const FrictionProblem good = grain_problem({});
  CHECK(fits(good));
  FrictionProblem other = good;
  other.dynamics.mass[1] = other.dynamics.mass[6] = 1e-7;  // couples linear unknowns
  CHECK_FALSE(fits(other));
  other = good;
  other.dynamics.mass[0] *= 1.0 + 1e-15;
  CHECK_FALSE(fits(other));
  other = good;
  for (int c = 0; c < other.contact_count(); ++c) {  // on one side the linear part is not opposite
    const DynamicsForm& d = other.dynamics;
    if (d.body_a[c] < 0 || d.body_b[c] < 0 || d.body_dofs(d.body_b[c]) != 6) continue;
    other.dynamics.h[d.h_begin[c]] += 1e-9;
    break;
  }
  CHECK_FALSE(fits(other));
  CHECK_FALSE(fits(make_known_solution({}).problem));
  // Two walls in contact: both would have to go through the lanes.
  other = good;
  const int second = other.dynamics.add_body(Eigen::MatrixXd::Constant(1, 1, 0.5));
  other.add_contact(second - 1, second, 0.0, Eigen::MatrixXd::Constant(1, 1, -1.0),
                    Eigen::MatrixXd::Ones(1, 1));
  other.dynamics.v_free.conservativeResize(other.dynamics.dof_count());
  other.dynamics.v_free.tail<1>().setZero();
  other.dynamics.bias.conservativeResize(other.row_count());
  other.dynamics.bias.tail<1>().setZero();
  CHECK_FALSE(fits(other));
  // All contacts are on one grain: groups of one contact.
  CHECK_FALSE(fits(grain_problem({.grains = 2, .contacts = 100, .has_wall = false})));
}
