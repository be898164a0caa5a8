// Lists of the command line: read whole, in the order that the comparison wants, or refused.

#include "experiments/compare/compare_options.hpp"

#include <stdexcept>

#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("Lists of counts are read whole or refused") {
  CHECK(parse_counts("1,20", 100) == std::vector<long>{1, 20});
  CHECK(parse_counts("20,1,20", 100) == std::vector<long>{20, 1, 20});  // as given
  for (const char* wrong : {"", "1,", ",1", "0", "-3", "1.5", "101", "x", "1 2"})
    CHECK_THROWS_AS(parse_counts(wrong, 100), std::invalid_argument);
  CHECK_THROWS_WITH(parse_counts("1,200", 100),
                    "'200': expected whole numbers from 1 to 100, separated by commas");
}

TEST_CASE("Tolerances come sorted from loose to tight, each once") {
  CHECK(parse_tolerances("1e-8,0.01,1e-4,1e-2") == std::vector<double>{1e-2, 1e-4, 1e-8});
  for (const char* wrong : {"", "1e-4,", "0", "-1", "nan", "inf", "1e-4x", "1e-4 1e-8"})
    CHECK_THROWS_AS(parse_tolerances(wrong), std::invalid_argument);
  CHECK_THROWS_WITH(parse_tolerances("1e-4,,2"), Catch::Contains("numbers > 0"));
}

TEST_CASE("Starts are cold or warm, each once") {
  CHECK(parse_starts("warm,cold,warm") == std::vector{StartKind::warm, StartKind::cold});
  CHECK_THROWS_WITH(parse_starts("tepid"), Catch::Contains("cold, warm"));
}

TEST_CASE("Solvers are taken from the list by name, each once, or all that were built") {
  const std::vector<ComparedSolver> two = parse_solvers("pgs,nncg,pgs");
  REQUIRE(two.size() == 2);
  CHECK(two[0].name == "pgs");
  CHECK(two[1].name == "nncg");
  CHECK(two[0].make() != nullptr);
  size_t built = 0;
  for (const SolverEntry& entry : solver_list()) built += entry.make != nullptr;
  CHECK(parse_solvers("all").size() == built);
  CHECK_THROWS_AS(parse_solvers("oracle"), UnknownSolver);
  CHECK_THROWS_AS(parse_solvers("pgs,"), std::invalid_argument);
}
