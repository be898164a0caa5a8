// What every registered backend must do. Adding a row to solver_list.cpp is enough to be tested here.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "problems/delassus.hpp"
#include "problems/known_solutions.hpp"
#include "solvers/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// Runs `check(entry)` for every backend that was built, each in a section of its own: `solvers_test -c NAME` tests
/// one.
template <typename Check>
void for_each_backend(const Check& check) {
  for (const SolverEntry& entry : solver_list())
    if (entry.make) DYNAMIC_SECTION(entry.name) {
        try {
          check(entry);
        } catch (const UnsupportedProblem& declined) {  // the limit is in its header; it must say so here, too
          CHECK(std::string(declined.what()).find(entry.name) != std::string::npos);
        }
      }
}

/// Nothing when the backend declines the problem's form.
std::optional<SolverRun> run(const SolverEntry& entry, const FrictionProblem& problem, const Budget& budget,
                             const Impulses& start = {}) {
  try {
    const auto solver = entry.make();
    return SolverRunner().run(*solver, problem, start, budget);
  } catch (const UnsupportedProblem&) {
    return std::nullopt;
  }
}

FrictionProblem only_delassus(FrictionProblem problem) {
  add_delassus_form(problem);
  problem.has_dynamics = false;
  return problem;
}

/// Problems up to this size every backend takes; a method of dense matrices may decline more.
constexpr int always_taken = 8;  // contacts

/// The dynamics form, or W for a backend that takes only that. Throws UnsupportedProblem where it declines the size.
SolverRun run_either(const SolverEntry& entry, const FrictionProblem& problem, const Budget& budget,
                     const Impulses& start = {}) {
  if (std::optional<SolverRun> result = run(entry, problem, budget, start)) return *result;
  try {
    return SolverRunner().run(*entry.make(), only_delassus(problem), start, budget);
  } catch (const UnsupportedProblem&) {
    REQUIRE(problem.contact_count() > always_taken);
    throw;
  }
}

std::optional<SolverRun> run_unless_large(const SolverEntry& entry, const FrictionProblem& problem,
                                          const Budget& budget) {
  try {
    return run_either(entry, problem, budget);
  } catch (const UnsupportedProblem&) {
    return std::nullopt;
  }
}

KnownSolution known(int bodies, int contacts, double friction, double mass_ratio, std::uint64_t seed = 1) {
  KnownSolutionSettings settings;
  settings.bodies = bodies;
  settings.contacts = contacts;
  settings.friction_max = friction;
  settings.mass_ratio = mass_ratio;
  settings.seed = seed;
  return make_known_solution(settings);
}

const Budget patient{.tolerance = 1e-8, .max_iterations = 100000, .max_seconds = 20.0};
const Budget hurried{.tolerance = 1e-8, .max_iterations = 2000, .max_seconds = 0.5};

/// Frictionless problems are the same under every law.
bool solves_coulomb(const SolverEntry& entry) { return entry.law == ContactLaw::coulomb; }

}  // namespace

TEST_CASE("problems with a known solution are solved, whatever their size and rank") {
  struct Size {
    int bodies, contacts;
  };
  for_each_backend([](const SolverEntry& entry) {
    for (const Size size : {Size{1, 1}, {2, 1}, {3, 2}, {10, 8}, {50, 40}, {200, 150}, {20, 40}, {30, 60}})
      for (const double friction : {0.0, 0.3, 0.8}) {
        if (friction > 0.0 && !solves_coulomb(entry)) continue;
        CAPTURE(size.bodies, size.contacts, friction);
        const KnownSolution exact = known(size.bodies, size.contacts, friction, 1.0);
        const std::optional<SolverRun> result = run_unless_large(entry, exact.problem, patient);
        if (!result) continue;
        CAPTURE(name_of(result->solved.reason), result->error.natural_map_rms);
        CHECK(result->success);
        // Impulses need not be unique, velocities near the solution are.
        Eigen::VectorXd u;
        contact_velocity(exact.problem, result->solved.impulses, u);
        CHECK((u - exact.u).lpNorm<Eigen::Infinity>() < 1e-5);
      }
  });
}

TEST_CASE("hard problems may not be solved, but no claim is false") {
  for_each_backend([](const SolverEntry& entry) {
    int claims = 0;
    for (const double friction : {0.0, 1.0, 3.0, 10.0})
      for (const double mass_ratio : {1.0, 1e3, 1e6})
        for (const int contacts : {2, 40, 60}) {
          CAPTURE(friction, mass_ratio, contacts);
          const std::optional<SolverRun> run =
              run_unless_large(entry, known(contacts == 60 ? 10 : 30, contacts, friction, mass_ratio).problem, hurried);
          if (!run) continue;
          const SolverRun& result = *run;
          CHECK(result.error.finite);
          if (result.solved.reason == StopReason::reached_tolerance && solves_coulomb(entry)) {
            ++claims;
            CAPTURE(result.solved.own_residual, result.error.natural_map_rms);
            CHECK(result.success);
          }
          CHECK(result.success == (result.solved.reason == StopReason::reached_tolerance &&
                                   result.error.natural_map_rms <= hurried.tolerance));
        }
    if (solves_coulomb(entry)) CHECK(claims > 5);
  });
}

TEST_CASE("contacts without friction, of one row or three") {
  for_each_backend([](const SolverEntry& entry) {
    KnownSolutionSettings settings;
    settings.frictionless_fraction = 1.0;
    const SolverRun one_row = run_either(entry, make_known_solution(settings).problem, patient);
    CHECK(one_row.success);
    settings.frictionless_fraction = 0.0;
    settings.friction_max = 0.0;
    const KnownSolution three = make_known_solution(settings);
    const SolverRun three_rows = run_either(entry, three.problem, patient);
    CHECK(three_rows.success);
    for (int c = 0; c < three.problem.contact_count(); ++c)
      CHECK(three_rows.solved.impulses.segment<2>(three.problem.row_begin[c] + 1).norm() <= 1e-8);
  });
}

TEST_CASE("no contacts, no bodies, and contacts that nothing moves") {
  for_each_backend([](const SolverEntry& entry) {
    const SolverRun none = run_either(entry, known(5, 0, 0.5, 1.0).problem, patient);
    CHECK(none.success);
    CHECK(none.solved.impulses.size() == 0);

    FrictionProblem fixed = known(5, 4, 0.5, 1.0).problem;  // one more contact, between two things that do not move
    fixed.row_begin.push_back(fixed.row_begin.back() + 3);
    fixed.friction.push_back(0.5);
    fixed.dynamics.body_a.push_back(-1);
    fixed.dynamics.body_b.push_back(-1);
    fixed.dynamics.h_begin.push_back(fixed.dynamics.h_begin.back());
    fixed.dynamics.bias.conservativeResize(fixed.row_count());
    fixed.dynamics.bias.tail<3>() << -1.0, 0.5, 0.5;
    const SolverRun result = run_either(entry, fixed, patient);
    CHECK(result.error.finite);
    if (solves_coulomb(entry)) CHECK(result.error.natural_map_rms <= patient.tolerance);
  });
}

TEST_CASE("contacts that all open take no impulse") {
  for_each_backend([](const SolverEntry& entry) {
    KnownSolutionSettings settings;
    settings.open_fraction = 1.0;
    // The relaxation presses contacts that leave more slowly than mu |u_T|.
    if (entry.law == ContactLaw::convex_relaxation) settings.friction_max = 0.0;
    const KnownSolution open = make_known_solution(settings);
    // Without impulses every contact leaves: u = H v_free + bias is the solution's.
    const SolverRun cold = run_either(entry, open.problem, patient);
    CHECK(cold.success);
    CHECK(cold.solved.impulses.lpNorm<Eigen::Infinity>() < 1e-7);
    const SolverRun misled =
        run_either(entry, open.problem, patient, Impulses::Constant(open.problem.row_count(), 1.0));
    if (solves_coulomb(entry)) CHECK(misled.success);
  });
}

TEST_CASE("a start that is no start never reaches the backend") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(10, 8, 0.3, 1.0).problem;
    CHECK_THROWS_AS(run(entry, problem, patient, Impulses::Zero(problem.row_count() - 1)), InvalidProblem);
    Impulses start = Impulses::Zero(problem.row_count());
    start[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(run(entry, problem, patient, start), InvalidProblem);
    FrictionProblem broken = problem;
    broken.dynamics.h[0] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(run(entry, broken, patient), InvalidProblem);
  });
}

TEST_CASE("limits of iterations and of time are kept") {
  for_each_backend([](const SolverEntry& entry) {
    FrictionProblem problem = known(200, 600, 0.8, 1e4).problem;
    for (const int contacts : {60, 8})
      if (!run_unless_large(entry, problem, {.max_iterations = 0})) problem = known(20, contacts, 0.8, 1e4).problem;
    for (const int limit : {0, 1, 3}) {
      Budget budget{.tolerance = 0.0, .max_iterations = limit};
      const SolverRun result = run_either(entry, problem, budget);
      CHECK(result.solved.iterations <= limit);
      CHECK(result.error.finite);
    }
    Budget budget{.tolerance = 0.0, .max_iterations = std::numeric_limits<int>::max(), .max_seconds = 0.05};
    const SolverRun result = run_either(entry, problem, budget);
    CHECK(result.solve_seconds < 2.0);
    CHECK(result.solved.reason != StopReason::iteration_limit);
  });
}

TEST_CASE("a start from the solution stops at once") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(50, 40, solves_coulomb(entry) ? 0.5 : 0.0, 1.0).problem;
    const SolverRun cold = run_either(entry, problem, patient);
    REQUIRE(cold.success);
    const SolverRun warm = run_either(entry, problem, patient, cold.solved.impulses);
    CHECK(warm.success);
    CHECK(warm.solved.iterations <= 1);
  });
}

TEST_CASE("both forms of a problem give the same answer") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(50, 40, 0.5, 1.0).problem;
    const Budget budget{.tolerance = 1e-10, .max_iterations = 100000, .max_seconds = 20.0};
    const auto dynamics = run(entry, problem, budget), delassus = run(entry, only_delassus(problem), budget);
    if (!dynamics && !delassus) throw UnsupportedProblem(std::string(entry.name) + " declines 40 contacts");
    if (!dynamics || !delassus) return;
    Eigen::VectorXd u, w;
    contact_velocity(problem, dynamics->solved.impulses, u);
    contact_velocity(problem, delassus->solved.impulses, w);
    CHECK((u - w).norm() < 1e-7 * u.norm());
  });
}

TEST_CASE("the same problem gives the same bits") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(30, 60, 0.5, 10.0).problem;
    const Budget budget{.tolerance = 1e-6, .max_iterations = 200};
    const SolverRun once = run_either(entry, problem, budget), again = run_either(entry, problem, budget);
    CHECK(once.solved.impulses == again.solved.impulses);
  });
}

TEST_CASE("history is kept on request, and ends with what is returned") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(50, 40, solves_coulomb(entry) ? 0.5 : 0.0, 1.0).problem;
    Budget budget = patient;
    const SolverRun silent = run_either(entry, problem, budget);
    CHECK(silent.solved.history.empty());
    budget.keep_history = true;
    const SolverRun result = run_either(entry, problem, budget);
    REQUIRE_FALSE(result.solved.history.empty());
    CHECK(result.solved.history.back().iteration == result.solved.iterations);
    CHECK(result.solved.history.back().error == Approx(result.error.natural_map_rms).epsilon(1e-3).margin(1e-14));
    for (std::size_t i = 1; i < result.solved.history.size(); ++i) {
      CHECK(result.solved.history[i].iteration > result.solved.history[i - 1].iteration);
      CHECK(result.solved.history[i].seconds >= result.solved.history[i - 1].seconds);
    }
  });
}

namespace {

/// A block of 1 kg on a plane: it would sink at 0.1 m/s and slide at 1 m/s along the heading.
FrictionProblem sliding_block(double heading) {
  FrictionProblem p;
  p.has_dynamics = true;
  p.row_begin = {0, 3};
  p.friction = {0.4};
  DynamicsForm& d = p.dynamics;
  d.dof_begin = {0, 3};
  d.mass_begin = {0, 9};
  d.mass = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  d.body_a = {-1};
  d.body_b = {0};
  d.h_begin = {0, 9};
  d.h = d.mass;
  d.v_free = Eigen::Vector3d(-0.1, std::cos(heading), std::sin(heading));
  d.bias = Eigen::Vector3d::Zero();
  return p;
}

}  // namespace

TEST_CASE("a sliding block tells the laws apart, and every label is true") {
  for_each_backend([](const SolverEntry& entry) {
    double largest_turn = 0.0;
    for (const double heading : {0.0, 0.3, 0.785398163397448, 2.0, 4.1}) {
      CAPTURE(heading);
      const FrictionProblem block = sliding_block(heading);
      const SolverRun result = run_either(entry, block, patient);
      const Impulses& r = result.solved.impulses;
      Eigen::VectorXd u;
      contact_velocity(block, r, u);
      const double slip = u.tail<2>().norm(), friction = r.tail<2>().norm();
      CHECK(result.error.cone_violation < 1e-9);
      if (entry.law == ContactLaw::convex_relaxation) {
        CHECK(slip == Approx(0.96 / 1.16));  // 1 - mu r_N with r_N = 0.1 + mu slip
        CHECK(u[0] == Approx(0.4 * slip).epsilon(1e-6));
        CHECK(friction == Approx(0.4 * r[0]).epsilon(1e-6));
      } else {
        CHECK(slip > 0.9);
        CHECK(std::abs(u[0]) < 1e-7);
        CHECK(r[0] == Approx(0.1).epsilon(1e-6));
      }
      // how far friction is from -mu r_N u_T / |u_T|
      const double turn = (r.tail<2>() + 0.4 * r[0] * u.tail<2>() / slip).norm() / (0.4 * r[0]);
      largest_turn = std::max(largest_turn, turn);
      if (entry.law == ContactLaw::pyramid) CHECK(turn < 0.8);  // a corner or a side of the polygon
    }
    if (entry.law == ContactLaw::pyramid)
      CHECK(largest_turn > 1e-2);
    else
      CHECK(largest_turn < 1e-5);
  });
}
