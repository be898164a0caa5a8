#pragma once
// Common to the conformance tests: every backend, problems of a size that it must take, and
// budgets.

#include <algorithm>
#include <optional>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/seam/run_solver.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/delassus_form.hpp"

namespace ballast {

/// Runs `check(entry)` for every backend that was built, each in a section of its own:
/// `solvers_test -c NAME` tests one.
template <typename Check>
void for_each_backend(const Check& check) {
  for (const SolverEntry& entry : solver_list())
    if (entry.make) DYNAMIC_SECTION(entry.name) {
        check(entry);
      }
}

/// `wanted`, or the number of contacts with friction that the backend takes, if it is smaller.
inline int contacts_for(const SolverEntry& entry, int wanted) {
  return entry.largest == 0 ? wanted : std::min(wanted, entry.largest);
}

/// Returns nothing if the backend declines the problem's form or size.
inline std::optional<SolverRun> run(const SolverEntry& entry, const FrictionProblem& problem,
                                    const Budget& budget, const Impulses& start = {}) {
  try {
    const auto solver = entry.make();
    return SolverRunner().run(*solver, problem, start, budget);
  } catch (const UnsupportedProblem& declined) {
    CHECK(std::string(declined.what()).find(entry.name) != std::string::npos);
    return std::nullopt;
  }
}

/// Runs on the dynamics form, or on W for a backend that takes only W. Returns nothing if it
/// declines both, which it may only do beyond its limit.
inline std::optional<SolverRun> run_unless_large(const SolverEntry& entry,
                                                 const FrictionProblem& problem,
                                                 const Budget& budget, const Impulses& start = {}) {
  if (std::optional<SolverRun> result = run(entry, problem, budget, start)) return result;
  std::optional<SolverRun> result = run(entry, only_delassus(problem), budget, start);
  if (!result) REQUIRE((entry.largest > 0 && problem.contact_count() > entry.largest));
  return result;
}

/// For problems within the limit of the backend.
inline SolverRun run_either(const SolverEntry& entry, const FrictionProblem& problem,
                            const Budget& budget, const Impulses& start = {}) {
  std::optional<SolverRun> result = run_unless_large(entry, problem, budget, start);
  REQUIRE(result);
  return *std::move(result);
}

inline KnownSolution known(int bodies, int contacts, double friction, double mass_ratio,
                           std::uint64_t seed = 1) {
  return make_known_solution({.bodies = bodies,
                              .contacts = contacts,
                              .friction_max = friction,
                              .mass_ratio = mass_ratio,
                              .seed = seed});
}

inline const Budget patient{.tolerance = 1e-8, .max_iterations = 100000, .max_seconds = 120.0};
inline const Budget hurried{.tolerance = 1e-8, .max_iterations = 2000, .max_seconds = 0.5};

/// True for the exact law. Frictionless problems are the same under every law.
inline bool solves_coulomb(const SolverEntry& entry) { return entry.law == ContactLaw::coulomb; }

}  // namespace ballast
