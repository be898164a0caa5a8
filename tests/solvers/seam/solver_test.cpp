#include "solvers/seam/solver.hpp"

#include "tests/catch.hpp"

using namespace ballast;

TEST_CASE("every reason and every law has a name of its own, as records keep it") {
  CHECK(std::string(name_of(StopReason::reached_tolerance)) == "reached_tolerance");
  CHECK(std::string(name_of(StopReason::iteration_limit)) == "iteration_limit");
  CHECK(std::string(name_of(StopReason::time_limit)) == "time_limit");
  CHECK(std::string(name_of(StopReason::stalled)) == "stalled");
  CHECK(std::string(name_of(StopReason::numerical_failure)) == "numerical_failure");
  CHECK(std::string(name_of(ContactLaw::coulomb)) == "coulomb");
  CHECK(std::string(name_of(ContactLaw::convex_relaxation)) == "convex_relaxation");
  CHECK(std::string(name_of(ContactLaw::pyramid)) == "pyramid");
}
