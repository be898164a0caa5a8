#include "solvers/solver_list.hpp"

#include <set>

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("every entry is complete and its name unique") {
  std::set<std::string> names;
  for (const SolverEntry& entry : solver_list()) {
    CAPTURE(entry.name);
    CHECK(names.insert(entry.name).second);
    CHECK(std::string(entry.description).size() > 10);
    if (entry.make)
      CHECK(make_solver(entry.name) != nullptr);
    else
      CHECK_THROWS_AS(make_solver(entry.name), MissingSolver);
    CHECK(&find_solver(entry.name) == &entry);
  }
  CHECK(names.count("pgs") == 1);
}

TEST_CASE("an unknown name is answered with those there are") {
  try {
    make_solver("pgz");
    FAIL("no exception");
  } catch (const UnknownSolver& error) {
    CHECK(std::string(error.what()).find("pgz") != std::string::npos);
    CHECK(std::string(error.what()).find("pgs") != std::string::npos);
  }
}
