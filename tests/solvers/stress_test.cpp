// Every backend on the stress problems: no NaN, no hang, no false success, and the known answer
// where it claims one. Its answers for problems that no impulses solve, and for an unsymmetric W.

#include "problems/algebra/made_problems.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "problems/algebra/contact_error.hpp"
#include "tests/problems/algebra/unsolvable.hpp"
#include "tests/solvers/conformance_support.hpp"

using namespace ballast;

namespace {

const Budget short_budget{.tolerance = 1e-8, .max_iterations = 20000, .max_seconds = 0.5};
/// For tests that demand an answer: the speed of the machine must not decide.
const Budget unhurried{.tolerance = 1e-8, .max_iterations = 20000, .max_seconds = 20.0};

/// The time by which a solve may overrun its limit [s]: AddressSanitizer's forks alone take a
/// second on a loaded machine.
#ifdef __SANITIZE_ADDRESS__
constexpr double overrun = 10.0;
#else
constexpr double overrun = 2.0;
#endif

double distance(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() > 0 ? (a - b).lpNorm<Eigen::Infinity>() : 0.0;
}

/// The velocity error that an error of 1e-8 in the contacts may give: the worst amplification of
/// these problems is 1e3.
constexpr double near = 1e-5;

void check_answer(const StressProblem& stress, const Impulses& r) {
  Eigen::VectorXd x;
  contact_velocity(stress.problem, r, x);
  if (stress.u.size() > 0) CHECK(distance(stress.u, x) < near);
  if (stress.v.size() == 0) return;
  body_velocity(stress.problem.dynamics, stress.problem.row_begin, r, x);
  CHECK(distance(stress.v, x) < near);
}

/// error(k+1) / error(k) of Gauss-Seidel, once only the slowest mode is left.
double gauss_seidel_rate(const FrictionProblem& problem, int sweeps) {
  std::vector<double> errors;
  for (const int limit : {sweeps, 2 * sweeps}) {
    const Budget budget{.tolerance = 0.0, .max_iterations = limit};
    errors.push_back(
        SolverRunner().run(*make_solver("pgs"), problem, {}, budget).error.natural_map_rms);
  }
  return std::pow(errors[1] / errors[0], 1.0 / sweeps);
}

}  // namespace

TEST_CASE("stress: every backend, every problem") {
  const std::vector<StressProblem> problems = stress_problems();
  for_each_backend([&](const SolverEntry& entry) {
    for (const StressProblem& stress : problems) {
      CAPTURE(stress.name);
      const std::optional<SolverRun> result = run(entry, stress.problem, short_budget);
      if (!result) continue;
      CAPTURE(name_of(result->solved.reason), result->error.natural_map_rms);
      CHECK(result->error.finite);
      CHECK(result->solve_seconds < short_budget.max_seconds + overrun);
      CHECK(result->solved.iterations <= short_budget.max_iterations);
      if (result->solved.reason == StopReason::reached_tolerance && solves_coulomb(entry))
        CHECK(result->is_solved());
      if (result->is_solved()) check_answer(stress, result->solved.impulses);
    }
  });
}

/// Velocities of 250 cm/s with a tolerance of 1e-8 cm/s, and a start at which Fischer and
/// Burmeister's function has a kink.
TEST_CASE("stress: rounding and kinks do not stop Newton's methods") {
  const std::pair<const char*, const char*> solved[] = {{"newton_ac", "units of gram and cm"},
                                                        {"newton_fb", "units of gram and cm"},
                                                        {"newton_fb", "stack of 2, top 1000.0 kg"}};
  const std::vector<StressProblem> problems = stress_problems();
  for (const auto& [name, problem_name] : solved) {
    const SolverEntry& entry = find_solver(name);
    if (!entry.make) continue;
    CAPTURE(name, problem_name);
    const auto stress = std::ranges::find(problems, problem_name, &StressProblem::name);
    REQUIRE(stress != problems.end());
    const std::optional<SolverRun> result = run(entry, stress->problem, unhurried);
    REQUIRE(result);
    CHECK(result->is_solved());
    CHECK(result->solved.iterations < 500);
  }
}

TEST_CASE("stress: answers are solutions") {
  int known = 0;
  for (const StressProblem& stress : stress_problems()) {
    CAPTURE(stress.name);
    REQUIRE_NOTHROW(stress.problem.validate());
    CHECK(stress.problem.contact_count() <= 60);
    const Budget patient{.tolerance = 1e-12, .max_iterations = 2000000, .max_seconds = 5.0};
    const SolverRun result = SolverRunner().run(*make_solver("pgs"), stress.problem, {}, patient);
    if (result.error.natural_map_rms > 1e-9) continue;  // Gauss-Seidel cannot solve R = 1e6
    check_answer(stress, result.solved.impulses);
    ++known;
  }
  CHECK(known > 20);
}

TEST_CASE(
    "stress: Gauss-Seidel contracts by R / (1 + R) on a mass-ratio stack, by cos^2(pi / 2n) on n "
    "equal boxes") {
  for (const int rows : {1, 3}) {
    for (const double ratio : {1.0, 10.0, 1000.0}) {
      CAPTURE(rows, ratio);
      CHECK(gauss_seidel_rate(mass_stack({1.0, ratio}, rows).problem, 10) ==
            Approx(ratio / (1.0 + ratio)).epsilon(1e-6));
    }
    for (const int n : {2, 5, 20}) {
      CAPTURE(rows, n);
      const double cosine = std::cos(M_PI / (2.0 * n));
      const FrictionProblem problem = mass_stack(std::vector<double>(n, 1.0), rows).problem;
      CHECK(gauss_seidel_rate(problem, n < 5 ? 20 : 5 * n * n / 4) ==
            Approx(cosine * cosine).epsilon(1e-4));
    }
  }
}

namespace {

const Budget brief{.tolerance = 1e-8, .max_iterations = 500, .max_seconds = 1.0};

/// A stored W whose diagonal blocks deviate from symmetry by `part` of their diagonal, as with
/// implicit gyroscopic terms, and q such that some contacts slide, some stick and some open.
FrictionProblem gyroscopic(double part, std::uint64_t seed) {
  FrictionProblem problem = only_delassus(known(4, 5, 0.8, 10.0, seed).problem);
  SparseRows& w = problem.delassus.w;
  for (int c = 0; c < problem.contact_count(); ++c) {
    const int first = problem.row_begin[c];
    if (problem.contact_rows(c) < 3) continue;
    for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)}) {
      const double size =
          0.5 * part * std::sqrt(w.coeff(first + i, first + i) * w.coeff(first + j, first + j));
      w.coeffRef(first + i, first + j) += size;
      w.coeffRef(first + j, first + i) -= size;
    }
  }
  w.makeCompressed();
  return problem;
}

}  // namespace

TEST_CASE("no backend solves what has no solution, and the two say so") {
  for_each_backend([](const SolverEntry& entry) {
    const std::optional<SolverRun> immovable = run(entry, immovable_contact(-1.0), brief);
    if (immovable) CHECK(immovable->verdict == Verdict::no_solution);
    const std::optional<SolverRun> squeezed = run(entry, squeezed_contacts(), brief);
    if (!squeezed) return;
    CAPTURE(name_of(squeezed->solved.reason), squeezed->solved.impulses.transpose());
    CHECK_FALSE(squeezed->is_solved());
  });
}

TEST_CASE("with the greatest friction a claim is as good as with any") {
  for_each_backend([](const SolverEntry& entry) {
    for (const double mu : {10.0, 1e3, largest_friction}) {
      const std::optional<SolverRun> result = run(entry, rough_contact(mu), brief);
      if (!result) return;
      CAPTURE(mu, name_of(result->verdict), result->error.natural_map_rms,
              result->error.approach_rms, result->solved.impulses.transpose());
      CHECK(result->error.finite);
      if (result->is_solved()) CHECK(result->error.min_normal_velocity > -4e-8);
    }
  });
}

TEST_CASE("W is judged as it is stored, symmetric or not") {
  int solved = 0, backends = 0;
  for (const SolverEntry& entry : solver_list()) {
    if (!entry.make) continue;
    CAPTURE(entry.name);
    ++backends;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      const FrictionProblem problem = gyroscopic(0.16, seed);
      const std::optional<SolverRun> result = run(entry, problem, brief);
      if (!result || !result->is_solved()) continue;
      ++solved;
      // u = W r + q with the stored W, entry by entry.
      const Eigen::VectorXd u =
          Eigen::MatrixXd(problem.delassus.w) * result->solved.impulses + problem.delassus.q;
      for (int c = 0; c < problem.contact_count(); ++c) CHECK(u[problem.row_begin[c]] > -1e-7);
      if (entry.law != ContactLaw::coulomb) continue;
      for (int c = 0; c < problem.contact_count(); ++c) {
        const int first = problem.row_begin[c];
        if (problem.contact_rows(c) < 3) continue;
        const Eigen::Vector3d r = result->solved.impulses.segment<3>(first);
        const double slip = u.segment<2>(first + 1).norm();
        // Sliding contacts have the friction mu r_N against the slip.
        CHECK(std::abs(r.tail<2>().dot(u.segment<2>(first + 1)) +
                       problem.friction[c] * r[0] * slip) < 1e-5);
      }
    }
  }
  CHECK(solved > 2 * backends);  // of three problems each, with any backends that a build has
}
