// Sweeps in single precision that are corrected in double at every check; groups of open contacts
// that are skipped between two checks.

#include <cmath>

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/backends/backends.hpp"
#include "tests/catch.hpp"
#include "tests/solvers/gauss_seidel/grain_problem.hpp"
#include "tests/support/solved.hpp"

using namespace ballast;
using samples::grain_problem;
using samples::Wide;

namespace {

/// Contacts just outside their cones whose guess lies beyond a pole of the slip equation: two
/// Newton steps from there overflow in single precision. One such contact of 4062 ended a run.
/// Their bodies do not matter: in the first sweep the biases determine the impulses that stop them.
template <typename Number, typename Loops>
void check_far_guesses(const Loops& loops, double accuracy) {
  constexpr double s2 = 5.48044634, c1 = 0.563586771, c2 = -0.0149795767, mu = 0.171148002;
  Random random(7);
  const auto near = [&random](double x) { return x + random.uniform(-1.5e-5, 1.5e-5); };
  for (int k = 0; k < 2000; ++k) {
    FrictionGroup<Number> group = {};
    GroupImpulses<Number, 3> impulses = {};
    BodyRow<Number> still = {};
    for (int lane = 0; lane < group_lanes; ++lane) {
      group.s2[lane] = static_cast<Number>(s2);
      group.inverse_s2[lane] = 1 / group.s2[lane];
      group.c1[lane] = static_cast<Number>(c1);
      group.c2[lane] = static_cast<Number>(c2);
      group.mu[lane] = static_cast<Number>(mu);
      group.inverse_mu[lane] = 1 / group.mu[lane];
      group.bias[0][lane] = static_cast<Number>(-near(0.194376));
      group.bias[1][lane] = static_cast<Number>(-near(0.0279209));
      group.bias[2][lane] = static_cast<Number>(-near(0.0125614) * s2);
    }
    double squares[2];
    loops.sweep({{&group, &impulses, nullptr, nullptr, 1}, {}}, nullptr, &still, squares);
    for (int lane = 0; lane < group_lanes; ++lane) {
      // The contact slides: |t| = mu N.
      const double t1 = impulses.y[1][lane], t2 = impulses.y[2][lane],
                   n = impulses.y[0][lane] - c1 * t1 - c2 * t2;
      const double miss = (std::hypot(t1, t2) - mu * n) / n;
      REQUIRE(std::isfinite(miss));
      REQUIRE(miss < accuracy);
    }
  }
}

/// A row of bodies: the first runs at 1 m/s into the second, which rests against the third, and so
/// on; there is a gap before the last. The first bodies share out their speed until that gap
/// closes. Contacts are numbered from the row's end, so that each sweep carries the push one body
/// further. The first sweep solves all other contacts: some closed, most open.
struct RowOfBodies {
  static constexpr int bodies = 9, closed = 249, open = 14000;  // beyond far_bytes
  static constexpr int gap =
      bodies - 2 + closed;  ///< the contact with the gap; the groups before it are full
  FrictionProblem problem;

  RowOfBodies() {
    problem.has_dynamics = true;
    for (int b = 0; b < bodies + closed + open; ++b)
      problem.dynamics.add_body(Eigen::MatrixXd::Identity(6, 6));
    std::vector<double> bias;
    const auto add = [&](int a, int b, double opening) {
      const Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(3, 6);
      problem.add_contact(a, b, 0.5, a < 0 ? Eigen::MatrixXd() : Eigen::MatrixXd(-rows), rows);
      bias.insert(bias.end(), {opening, 0.0, 0.0});
    };
    for (int b = bodies - 3; b >= 0; --b) add(b, b + 1, 0.0);
    for (int k = 0; k < closed; ++k) add(-1, bodies + k, -1e-3);
    add(bodies - 2, bodies - 1, 0.1);
    for (int k = 0; k < open; ++k) add(-1, bodies + closed + k, 1.0);
    DynamicsForm& d = problem.dynamics;
    d.bias = Eigen::VectorXd::Map(bias.data(), static_cast<Eigen::Index>(bias.size()));
    d.v_free.setZero(d.dof_count());
    d.v_free[0] = 1.0;
  }
};

}  // namespace

TEST_CASE("single: errors fall as in double, for mass ratios up to a million") {
  for (const double mass_ratio : {1.0, 1e3, 1e6}) {
    const FrictionProblem problem = grain_problem({.mass_ratio = mass_ratio, .seed = 6});
    Wide single(problem, true), exact(problem, false);
    for (const int sweeps : {10, 20, 50, 100, 200}) {
      for (int k = 0; k < sweeps; ++k) {
        single.sweep.sweep();
        exact.sweep.sweep();
      }
      const double found = single.sweep.error(), expected = exact.sweep.error();
      INFO("mass ratio " << mass_ratio << ", sweeps " << sweeps);
      CHECK(found == Approx(expected).epsilon(0.02));
      Impulses r;
      single.sweep.store(problem, r);
      const double judged = contact_error(problem, r).natural_map_rms;
      CHECK(judged <= found);
      CHECK(found <= judged * (1.0 + 1.0 / 25.0));
    }
  }
}

TEST_CASE("single: a rough look sees the error, now and then it is in double") {
  const FrictionProblem problem = grain_problem({.mass_ratio = 1e3, .seed = 6});
  Wide single(problem, true);
  Impulses r;
  single.sweep.error();
  for (int look = 0; look < 10; ++look) {
    for (int k = 0; k < 20; ++k) single.sweep.sweep();
    const double rough = single.sweep.rough_error();
    CHECK_FALSE(single.sweep.is_storable());
    CHECK(single.sweep.error() >= rough);
    CHECK(single.sweep.is_storable());
    single.sweep.store(problem, r);
    CHECK(contact_error(problem, r).natural_map_rms == Approx(rough).epsilon(1e-4));
  }
  int in_double = 0;
  for (int look = 0; look < 10; ++look) {
    for (int k = 0; k < 20; ++k) single.sweep.sweep();
    single.sweep.rough_error();
    in_double += single.sweep.is_storable();
  }
  CHECK(in_double == 2);  // every fourth
}

TEST_CASE("single: a guess that overflows is not taken for a slip root") {
  for (const GroupKernels* kernels : all_group_kernels()) {
    INFO(kernels->instruction_set);
    check_far_guesses<float>(kernels->single.friction, 1e-5);
    check_far_guesses<double>(kernels->exact.friction, 1e-10);
  }
}

TEST_CASE("single: leaves by itself where its rounding would show") {
  const FrictionProblem problem =
      grain_problem({.grains = 600, .contacts = 300, .reach = 300, .seed = 4});  // few contacts
  Wide single(problem, true);
  single.sweep.sweep();
  CHECK(single.sweep.is_single());
  double error = single.sweep.error();
  for (int look = 0; look < 40; ++look) {
    if (single.sweep.is_single()) CHECK(error > 1e-9 * velocity_scale(problem));
    for (int k = 0; k < 20; ++k) single.sweep.sweep();
    error = single.sweep.error();
  }
  CHECK_FALSE(single.sweep.is_single());
  CHECK(error < 1e-12 * velocity_scale(problem));
}

TEST_CASE("single: with momentum rounding does not pile up") {
  const FrictionProblem problem = grain_problem({.grains = 600, .contacts = 2000, .seed = 4});
  // The least error that is seen before single precision is left.
  const auto least = [&](double beta) {
    Wide single(problem, true);
    single.sweep.start_search();
    double error = single.sweep.error(), seen = error;
    for (int look = 0; look < 60 && single.sweep.is_single(); ++look) {
      seen = error;
      for (int k = 0; k < 60; ++k) single.sweep.sweep_along({k % 60 < 50 ? beta : 0.0});
      error = single.sweep.error();
    }
    return seen;
  };
  CHECK(least(0.9) < 0.6 * least(0.0));
}

TEST_CASE("single: loaded impulses are stored as they were, swept ones on their cones") {
  const FrictionProblem problem = grain_problem({.seed = 2});
  Wide single(problem, true), exact(problem, false);
  const Impulses start = Impulses::Constant(problem.row_count(), 1.0 / 3e5);
  Impulses r, expected;
  for (Wide* sweep : {&single, &exact}) sweep->sweep.load(problem, start);
  single.sweep.store(problem, r);
  exact.sweep.store(problem, expected);
  CHECK(r == expected);
  single.sweep.error();
  single.sweep.store(problem, r);
  CHECK(r == expected);
  for (int k = 0; k < 30; ++k) single.sweep.sweep();
  CHECK(single.sweep.error() > 0.0);
  CHECK(single.sweep.is_single());
  single.sweep.store(problem, r);
  CHECK(contact_error(problem, r).cone_violation <= 1e-15 * r.norm());
}

TEST_CASE("single: a start too good for it is kept, digit by digit") {
  const FrictionProblem problem = grain_problem({.seed = 2});
  const Solved solved =
      from_rest(*make_gauss_seidel(), problem,
                {.tolerance = 1e-12 * velocity_scale(problem), .max_iterations = 100000});
  REQUIRE(solved.reason == StopReason::reached_tolerance);
  Wide single(problem, true), exact(problem, false);
  Impulses r, expected;
  for (Wide* sweep : {&single, &exact}) sweep->sweep.load(problem, solved.impulses);
  CHECK(single.sweep.is_single());
  CHECK(single.sweep.error() == exact.sweep.error());
  CHECK_FALSE(single.sweep.is_single());
  for (Wide* sweep : {&single, &exact}) sweep->sweep.sweep();
  single.sweep.store(problem, r);
  exact.sweep.store(problem, expected);
  CHECK(r == expected);
  single.sweep.load(problem, Impulses::Zero(problem.row_count()));
  single.sweep.sweep();
  CHECK(single.sweep.is_single());  // single again after load()
}

TEST_CASE("single: open contacts that rest change no bit") {
  FrictionProblem problem = grain_problem({.grains = 1200, .contacts = 5000, .seed = 9});
  // A third of the contacts have gaps.
  Random random(9);
  for (int c = 0; c < problem.contact_count(); ++c)
    if (random.below(3) == 0)
      problem.dynamics.bias[problem.row_begin[c]] = random.uniform(0.0, 9.0);
  for (const auto& [threads, is_conjugate] : {std::pair(1, true), {2, false}}) {
    Wide rests(problem, true, *all_group_kernels().front(), threads), all(problem, true);
    all.sweep.allow_rests(false);
    for (Wide* sweep : {&rests, &all}) sweep->sweep.start_search();
    int resting = 0;
    for (int k = 0; k < 120; ++k) {
      const SearchStep step = samples::varied_step(k, is_conjugate);
      const double square = all.sweep.sweep_along(step);
      REQUIRE(rests.sweep.sweep_along(step) == square);
      if (k % 12 != 5) continue;
      const double error = all.sweep.error();
      REQUIRE(rests.sweep.error() == error);
      resting = std::max(resting, rests.sweep.resting_groups());
      CHECK(all.sweep.resting_groups() == 0);
    }
    CHECK(resting > 40);  // of about 400
    Impulses r, expected;
    rests.sweep.store(problem, r);
    all.sweep.store(problem, expected);
    CHECK(r == expected);
  }
}

TEST_CASE("single: a contact that has to close while it rests is seen by the next look") {
  const RowOfBodies row;
  const int at_gap = row.problem.row_begin[RowOfBodies::gap];
  Wide sweep(row.problem, true), all(row.problem, true);
  all.sweep.allow_rests(false);
  Impulses r;
  const auto impulse = [&](Wide& of) {
    of.sweep.error();
    of.sweep.store(row.problem, r);
    return r[at_gap];
  };
  for (Wide* of : {&sweep, &all}) {
    of->sweep.sweep();
    CHECK(impulse(*of) == 0.0);
  }
  CHECK(sweep.sweep.resting_groups() > RowOfBodies::open / group_lanes - 2);
  for (int k = 0; k < 100; ++k)
    for (Wide* of : {&sweep, &all}) of->sweep.sweep();
  CHECK(impulse(all) > 0.01);
  CHECK(impulse(sweep) == 0.0);  // its group rested
  for (int k = 0; k < 200; ++k) sweep.sweep.sweep();
  CHECK(impulse(sweep) == Approx(0.125 - 0.1).epsilon(0.2));
  CHECK(contact_error(row.problem, r).natural_map_rms < 1e-6);
}

TEST_CASE("single: backends that use it converge far below its rounding") {
  const FrictionProblem problem = grain_problem({.grains = 300, .contacts = 800, .seed = 7});
  const double tolerance = 1e-10 * velocity_scale(problem);
  for (const bool nncg : {false, true}) {
    const Solved solved =
        from_rest(*(nncg ? make_nncg() : make_gauss_seidel()), problem,
                  {.tolerance = tolerance, .max_iterations = 100000, .max_seconds = 1e30});
    CHECK(solved.reason == StopReason::reached_tolerance);
    CHECK(contact_error(problem, solved.impulses).natural_map_rms <= tolerance);
  }
}

TEST_CASE("nncg stops soon after its tolerance is reached, after few looks at the error") {
  int solves = 0, with_fewer = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const FrictionProblem problem =
        grain_problem({.grains = 600, .contacts = 2400, .reach = 20, .seed = seed});
    const auto solve = [&](double tolerance, int most) {
      return from_rest(*make_nncg(), problem,
                       {.tolerance = tolerance, .max_iterations = most, .keep_history = true});
    };
    for (const double relative : {3e-3, 1e-3, 3e-4, 1e-4}) {
      const double tolerance = relative * velocity_scale(problem);
      const Solved solved = solve(tolerance, 3000);
      INFO("seed " << seed << ", relative " << relative << ", iterations " << solved.iterations);
      if (solved.reason != StopReason::reached_tolerance) continue;
      REQUIRE(solved.iterations > 10);
      CHECK(solved.history.size() < 6.0 + std::log(solved.iterations) / std::log(1.25));
      ++solves;
      // Nine tenths of the iterations are seldom enough.
      with_fewer +=
          solve(tolerance, solved.iterations * 9 / 10).reason != StopReason::iteration_limit;
    }
  }
  CHECK(solves > 24);
  CHECK(with_fewer < solves / 12);
}
