#include "solvers/solver_list.hpp"

#include <set>

#include "problems/algebra/known_solutions.hpp"
#include "solvers/backends/backends.hpp"
#include "solvers/parts/sparse_factor.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("every entry is complete and its name unique") {
  std::set<std::string> names;
  for (const SolverEntry& entry : solver_list()) {
    CAPTURE(entry.name);
    CHECK(names.insert(entry.name).second);
    CHECK(std::string(entry.description).size() > 10);
    if (entry.make) CHECK(make_solver(entry.name) != nullptr);
    CHECK(&find_solver(entry.name) == &entry);
  }
  CHECK(names.count("pgs") == 1);
}

TEST_CASE("an unknown name is answered with those there are") {
  CHECK_THROWS_AS(make_solver("pgz"), UnknownSolver);
  CHECK_THROWS_WITH(make_solver("pgz"), Catch::Contains("pgz") && Catch::Contains("pgs"));
}

TEST_CASE("a backend is missing exactly where its library is, and says what to install") {
  for (const SolverEntry& entry : solver_list()) {
    CAPTURE(entry.name);
    if (entry.make) {
      CHECK(entry.make() != nullptr);
      continue;
    }
    CHECK(!std::string(entry.package).empty());
    CHECK_THROWS_AS(make_solver(entry.name), MissingSolver);
    CHECK_THROWS_WITH(make_solver(entry.name), Catch::Contains(entry.package));
  }
  CHECK((find_solver("auto").make != nullptr) == has_sparse_factors());
}

TEST_CASE("what factorises compiles everywhere, and declines where there are no factors") {
  const FrictionProblem problem = make_known_solution({.bodies = 4, .contacts = 3}).problem;
  if (has_sparse_factors())
    CHECK_NOTHROW(make_admm()->prepare(problem));
  else
    CHECK_THROWS_AS(make_admm()->prepare(problem), UnsupportedProblem);
}
