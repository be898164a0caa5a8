// Requirements of every registered backend: its answers; limits of size, iterations and time;
// repeatability; history. A row in solver_list.cpp is enough to be tested here.

#include <cmath>
#include <limits>

#include "tests/solvers/conformance_support.hpp"
#include "tests/support/fixed_contact.hpp"

using namespace ballast;

TEST_CASE("problems with a known solution are solved, whatever their size and rank") {
  struct Size {
    int bodies, contacts;
  };
  for_each_backend([](const SolverEntry& entry) {
    for (const Size size :
         {Size{1, 1}, {2, 1}, {3, 2}, {10, 8}, {50, 40}, {200, 150}, {20, 40}, {30, 60}})
      for (const double friction : {0.0, 0.3, 0.8}) {
        if (friction > 0.0 && !solves_coulomb(entry)) continue;
        if (friction == 0.3 && size.contacts > 10) continue;  // general solvers need seconds
        CAPTURE(size.bodies, size.contacts, friction);
        const KnownSolution exact = known(size.bodies, size.contacts, friction, 1.0);
        const std::optional<SolverRun> result = run_unless_large(entry, exact.problem, patient);
        if (!result) continue;
        CAPTURE(name_of(result->solved.reason), result->error.natural_map_rms);
        CHECK(result->is_solved());
        // Impulses need not be unique, but velocities near the solution are.
        Eigen::VectorXd u;
        contact_velocity(exact.problem, result->solved.impulses, u);
        CHECK((u - exact.u).lpNorm<Eigen::Infinity>() < 1e-5);
      }
  });
}

TEST_CASE("hard problems may not be solved, but no claim is false") {
  for_each_backend([](const SolverEntry& entry) {
    int claims = 0, late = 0;
    for (const double friction : {0.0, 1.0, 10.0})
      for (const double mass_ratio : {1.0, 1e6})
        for (const int contacts : {2, 20, 60}) {
          CAPTURE(friction, mass_ratio, contacts);
          const std::optional<SolverRun> run = run_unless_large(
              entry, known(contacts == 60 ? 10 : 30, contacts, friction, mass_ratio).problem,
              hurried);
          if (!run) continue;
          const SolverRun& result = *run;
          CHECK(result.error.finite);
          late += result.solved.reason ==
                  StopReason::time_limit;  // as on a slow machine, under sanitizers
          if (result.solved.reason == StopReason::reached_tolerance && solves_coulomb(entry)) {
            ++claims;
            CAPTURE(result.solved.own_residual, result.error.natural_map_rms);
            CHECK(result.is_solved());
          }
          CHECK(result.is_solved() == (result.solved.reason == StopReason::reached_tolerance &&
                                       result.error.natural_map_rms <= hurried.tolerance));
        }
    if (solves_coulomb(entry)) CHECK(claims + late > 5);
  });
}

TEST_CASE("contacts without friction, of one row or three") {
  for_each_backend([](const SolverEntry& entry) {
    KnownSolutionSettings settings;
    settings.contacts = contacts_for(entry, settings.contacts);
    settings.frictionless_fraction = 1.0;
    const SolverRun one_row = run_either(entry, make_known_solution(settings).problem, patient);
    CHECK(one_row.is_solved());
    settings.frictionless_fraction = 0.0;
    settings.friction_max = 0.0;
    const KnownSolution three = make_known_solution(settings);
    const SolverRun three_rows = run_either(entry, three.problem, patient);
    CHECK(three_rows.is_solved());
    for (int c = 0; c < three.problem.contact_count(); ++c)
      CHECK(three_rows.solved.impulses.segment<2>(three.problem.row_begin[c] + 1).norm() <= 1e-8);
  });
}

TEST_CASE("no contacts, no bodies, and contacts that nothing moves") {
  for_each_backend([](const SolverEntry& entry) {
    const SolverRun none = run_either(entry, known(5, 0, 0.5, 1.0).problem, patient);
    CHECK(none.is_solved());
    CHECK(none.solved.impulses.size() == 0);

    FrictionProblem fixed =
        known(5, 4, 0.5, 1.0).problem;  // one more contact, between two things that do not move
    add_fixed_contact(fixed);
    const SolverRun result = run_either(entry, fixed, patient);
    CHECK(result.error.finite);
    if (solves_coulomb(entry)) CHECK(result.error.natural_map_rms <= patient.tolerance);
  });
}

TEST_CASE("contacts that all open take no impulse") {
  for_each_backend([](const SolverEntry& entry) {
    KnownSolutionSettings settings;
    settings.contacts = contacts_for(entry, settings.contacts);
    settings.open_fraction = 1.0;
    // The relaxation presses contacts that separate more slowly than mu |u_T|.
    if (entry.law == ContactLaw::convex_relaxation) settings.friction_max = 0.0;
    const KnownSolution open = make_known_solution(settings);
    // Without impulses every contact separates: u = H v_free + bias is that of the solution.
    const SolverRun cold = run_either(entry, open.problem, patient);
    CHECK(cold.is_solved());
    CHECK(cold.solved.impulses.lpNorm<Eigen::Infinity>() < 1e-7);
    const SolverRun misled =
        run_either(entry, open.problem, patient, Impulses::Constant(open.problem.row_count(), 1.0));
    if (solves_coulomb(entry)) CHECK(misled.is_solved());
  });
}

namespace {

/// A block of 1 kg on a plane that would sink at 0.1 m/s and slide at 1 m/s along the heading.
FrictionProblem sliding_block(double heading) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  FrictionProblem p;
  p.has_dynamics = true;
  p.dynamics.add_body(one);
  p.add_contact(-1, 0, 0.4, {}, one);
  p.dynamics.v_free = Eigen::Vector3d(-0.1, std::cos(heading), std::sin(heading));
  p.dynamics.bias = Eigen::Vector3d::Zero();
  return p;
}

}  // namespace

TEST_CASE("a sliding block tells the laws apart, and every label is true") {
  for_each_backend([](const SolverEntry& entry) {
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
      // The relative difference of friction from -mu r_N u_T / |u_T|.
      const double turn = (r.tail<2>() + 0.4 * r[0] * u.tail<2>() / slip).norm() / (0.4 * r[0]);
      CHECK(turn < 1e-5);
    }
  });
}

/// A backend takes every problem up to its stated limit, and takes no larger one.
TEST_CASE("a backend takes problems up to the size that the register says") {
  for_each_backend([](const SolverEntry& entry) {
    const auto is_taken = [&](int contacts) {
      const FrictionProblem problem = make_known_solution({.bodies = contacts,
                                                           .contacts = contacts,
                                                           .friction_min = 0.1,
                                                           .frictionless_fraction = 0.0})
                                          .problem;
      return run_unless_large(entry, problem, {.max_iterations = 0}).has_value();
    };
    CHECK(is_taken(entry.largest == 0 ? 2000 : entry.largest));
    if (entry.largest > 0) CHECK_FALSE(is_taken(entry.largest + 1));
  });
}

TEST_CASE("limits of iterations and of time are kept") {
  for_each_backend([](const SolverEntry& entry) {
    const int contacts = contacts_for(entry, 600);
    const FrictionProblem problem = known(std::max(2, contacts / 3), contacts, 0.8, 1e4).problem;
    for (const int limit : {0, 1, 3}) {
      Budget budget{.tolerance = 0.0, .max_iterations = limit};
      const SolverRun result = run_either(entry, problem, budget);
      CHECK(result.solved.iterations <= limit);
      CHECK(result.error.finite);
    }
    Budget budget{
        .tolerance = 0.0, .max_iterations = std::numeric_limits<int>::max(), .max_seconds = 0.05};
    const SolverRun result = run_either(entry, problem, budget);
    CHECK(result.solve_seconds < 2.0);
    CHECK(result.solved.reason != StopReason::iteration_limit);
  });
}

TEST_CASE("a start from the solution stops at once") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem =
        known(50, contacts_for(entry, 40), solves_coulomb(entry) ? 0.5 : 0.0, 1.0).problem;
    const SolverRun cold = run_either(entry, problem, patient);
    REQUIRE(cold.is_solved());
    const SolverRun warm = run_either(entry, problem, patient, cold.solved.impulses);
    CHECK(warm.is_solved());
    CHECK(warm.solved.iterations <= 1);
  });
}

TEST_CASE("both forms of a problem give the same answer") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(50, contacts_for(entry, 40), 0.5, 1.0).problem;
    const Budget budget{.tolerance = 1e-10, .max_iterations = 100000, .max_seconds = 20.0};
    const auto dynamics = run(entry, problem, budget),
               delassus = run(entry, only_delassus(problem), budget);
    REQUIRE((dynamics || delassus));
    if (!dynamics || !delassus) return;
    Eigen::VectorXd u, w;
    contact_velocity(problem, dynamics->solved.impulses, u);
    contact_velocity(problem, delassus->solved.impulses, w);
    CHECK((u - w).norm() < 1e-7 * u.norm());
  });
}

TEST_CASE("the same problem gives the same bits") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem = known(30, contacts_for(entry, 60), 0.5, 10.0).problem;
    const Budget budget{.tolerance = 1e-6, .max_iterations = 200};
    const SolverRun once = run_either(entry, problem, budget),
                    again = run_either(entry, problem, budget);
    CHECK(once.solved.impulses == again.solved.impulses);
  });
}

TEST_CASE("history is kept on request, and ends with what is returned") {
  for_each_backend([](const SolverEntry& entry) {
    const FrictionProblem problem =
        known(50, contacts_for(entry, 40), solves_coulomb(entry) ? 0.5 : 0.0, 1.0).problem;
    Budget budget = patient;
    const SolverRun silent = run_either(entry, problem, budget);
    CHECK(silent.solved.history.empty());
    budget.keep_history = true;
    const SolverRun result = run_either(entry, problem, budget);
    REQUIRE_FALSE(result.solved.history.empty());
    CHECK(result.solved.history.back().iteration == result.solved.iterations);
    CHECK(result.solved.history.back().error ==
          Approx(result.error.natural_map_rms).epsilon(1e-3).margin(1e-14));
    for (std::size_t i = 1; i < result.solved.history.size(); ++i) {
      CHECK(result.solved.history[i].iteration > result.solved.history[i - 1].iteration);
      CHECK(result.solved.history[i].seconds >= result.solved.history[i - 1].seconds);
    }
  });
}
