// Sweeps in single precision that are made good in double at every look.

#include <cmath>

#include "platform/random.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/backends/gauss_seidel.hpp"
#include "solvers/backends/nncg.hpp"
#include "tests/catch.hpp"
#include "tests/solvers/gauss_seidel/grain_problem.hpp"
#include "tests/solvers/gauss_seidel/single_sweep.hpp"

using namespace ballast;
using samples::grain_problem;
using samples::SingleSweep;

namespace {

/// Contacts whose bodies do not matter: in the first sweep the impulses (y, t1, t2) would stop
/// them.
template <typename Number>
struct LoneContacts {
  FrictionGroup<Number> group = {};
  GroupImpulses<Number, 3> impulses = {};
  BodyRow<Number> still = {};

  void set(int lane, double s2, double c1, double c2, double mu, const double (&stop)[3]) {
    group.s2[lane] = static_cast<Number>(s2);
    group.inverse_s2[lane] = 1 / group.s2[lane];
    group.c1[lane] = static_cast<Number>(c1);
    group.c2[lane] = static_cast<Number>(c2);
    group.mu[lane] = static_cast<Number>(mu);
    group.inverse_mu[lane] = 1 / group.mu[lane];
    group.bias[0][lane] = static_cast<Number>(-stop[0]);
    group.bias[1][lane] = static_cast<Number>(-stop[1]);
    group.bias[2][lane] = static_cast<Number>(-stop[2] * s2);
  }
  /// Of a contact that slides: |t| - mu N over N, with N = y - c1 t1 - c2 t2.
  double miss(int lane) const {
    const double y = impulses.y[0][lane], t1 = impulses.y[1][lane], t2 = impulses.y[2][lane],
                 n = y - group.c1[lane] * t1 - group.c2[lane] * t2;
    return (std::hypot(t1, t2) - group.mu[lane] * n) / n;
  }
};

/// Contacts just outside their cones whose guess lies beyond a pole of the slip equation: two
/// Newton steps from there overflow in single precision. One such contact of a run's 4062 ended it.
template <typename Number, typename Loops>
void check_far_guesses(const Loops& loops, double accuracy) {
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    LoneContacts<Number> contacts;
    for (int lane = 0; lane < group_lanes; ++lane) {
      const auto near = [&](double x) { return x + random.uniform(-1.5e-5, 1.5e-5); };
      contacts.set(lane, 5.48044634, 0.563586771, -0.0149795767, 0.171148002,
                   {near(0.194376), near(0.0279109 + 1e-5), near(0.0125614)});
    }
    loops.sweep({{&contacts.group, &contacts.impulses, nullptr, nullptr, 1}, {}}, &contacts.still);
    for (int lane = 0; lane < group_lanes; ++lane) {
      REQUIRE(std::isfinite(contacts.miss(lane)));
      REQUIRE(contacts.miss(lane) < accuracy);
    }
  }
}

/// rms over rows of q [m/s]: what errors are small against.
double velocity_scale(const FrictionProblem& problem) {
  return contact_error(problem, Impulses::Zero(problem.row_count())).velocity_scale;
}

}  // namespace

TEST_CASE("single: errors fall as in double, for mass ratios up to a million") {
  for (const double mass_ratio : {1.0, 1e3, 1e6}) {
    const FrictionProblem problem = grain_problem({.mass_ratio = mass_ratio, .seed = 6});
    SingleSweep single(problem, true), exact(problem, false);
    for (const int sweeps : {10, 20, 50, 100, 200}) {
      for (int k = 0; k < sweeps; ++k) {
        single.wide.sweep();
        exact.wide.sweep();
      }
      const double found = single.wide.error(), expected = exact.wide.error();
      INFO("mass ratio " << mass_ratio << ", sweeps " << sweeps);
      CHECK(found == Approx(expected).epsilon(0.02));
      Impulses r;
      single.wide.store(problem, r);
      CHECK(contact_error(problem, r).natural_map_rms == Approx(found).epsilon(1e-9));
    }
  }
}

TEST_CASE("single: the same bits on every instruction set, with any number of threads") {
  // Several slabs, so that threads have interiors and interfaces.
  const FrictionProblem problem = grain_problem({.grains = 1600, .contacts = 6000, .seed = 5});
  Impulses expected;
  std::vector<double> expected_errors;
  for (const GroupKernels* kernels : all_group_kernels())
    for (const int threads : {1, 2, 3, 8}) {
      SingleSweep single(problem, true, *kernels, threads);
      REQUIRE(single.plan.interiors().size() >= 2);
      single.wide.start_search();
      std::vector<double> errors;
      for (int k = 0; k < 20; ++k) {
        single.wide.sweep(SearchStep{k < 2 ? 0.0 : 0.5, k < 1 ? 0.0 : 1.0, k < 9 ? 0.0 : 0.4});
        if (k % 5 == 4) errors.push_back(single.wide.error());
      }
      CHECK(single.wide.is_single());
      errors.push_back(single.wide.error());
      Impulses r;
      single.wide.store(problem, r);
      if (expected.size() == 0) {
        expected = r;
        expected_errors = errors;
      }
      INFO(kernels->instruction_set << ", threads " << threads);
      CHECK(r == expected);
      CHECK(errors == expected_errors);
    }
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
      grain_problem({.grains = 600, .contacts = 300, .reach = 300, .seed = 4});  // few are joined
  SingleSweep single(problem, true);
  single.wide.sweep();
  CHECK(single.wide.is_single());
  double error = single.wide.error();
  for (int look = 0; look < 40; ++look) {
    if (single.wide.is_single()) CHECK(error > 1e-9 * velocity_scale(problem));
    for (int k = 0; k < 20; ++k) single.wide.sweep();
    error = single.wide.error();
  }
  CHECK_FALSE(single.wide.is_single());
  CHECK(error < 1e-12 * velocity_scale(problem));
}

TEST_CASE("single: loaded impulses are stored as they were; the last sweep is in double") {
  const FrictionProblem problem = grain_problem({.seed = 2});
  SingleSweep single(problem, true), exact(problem, false);
  const Impulses start = Impulses::Constant(problem.row_count(), 1.0 / 3e5);
  Impulses r, expected;
  for (SingleSweep* sweep : {&single, &exact}) sweep->wide.load(problem, start);
  single.wide.store(problem, r);
  exact.wide.store(problem, expected);
  CHECK(r == expected);
  CHECK_FALSE(single.wide.finish_in_double());  // no sweep yet
  single.wide.load(problem, start);
  for (int k = 0; k < 30; ++k) single.wide.sweep();
  CHECK(single.wide.error() > 0.0);
  CHECK(single.wide.finish_in_double());
  CHECK_FALSE(single.wide.is_single());
  single.wide.store(problem, r);
  const ContactError error = contact_error(problem, r);
  CHECK(error.cone_violation <= 1e-15 * r.norm());
  CHECK(single.wide.error() == Approx(error.natural_map_rms).epsilon(1e-9));
  single.wide.load(problem, start);
  single.wide.sweep();
  CHECK(single.wide.is_single());  // begins again
}

TEST_CASE("single: backends that use it converge far below its rounding") {
  const FrictionProblem problem = grain_problem({.grains = 300, .contacts = 800, .seed = 7});
  const double tolerance = 1e-10 * velocity_scale(problem);
  for (const bool nncg : {false, true}) {
    const std::unique_ptr<Solver> solver = nncg ? make_nncg() : make_gauss_seidel();
    solver->prepare(problem);
    const Solved solved =
        solver->solve(problem, Impulses::Zero(problem.row_count()),
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
    const auto solver = make_nncg();
    solver->prepare(problem);
    const auto solve = [&](double tolerance, int most) {
      return solver->solve(problem, Impulses::Zero(problem.row_count()),
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
      // A tenth fewer would not have been enough.
      with_fewer +=
          solve(tolerance, solved.iterations * 9 / 10).reason != StopReason::iteration_limit;
    }
  }
  CHECK(solves > 24);
  CHECK(with_fewer < solves / 12);
}
