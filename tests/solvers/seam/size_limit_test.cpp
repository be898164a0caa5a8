#include "solvers/seam/size_limit.hpp"

#include "tests/catch.hpp"

using namespace ballast;

namespace {

FrictionProblem with(std::vector<double> friction) {
  FrictionProblem problem;
  problem.friction = std::move(friction);
  return problem;
}

}  // namespace

TEST_CASE("a contact has friction when mu is above zero") {
  CHECK(contacts_with_friction(with({})) == 0);
  CHECK(contacts_with_friction(with({0.0, 0.3, 0.0, 1e-9})) == 2);
}

TEST_CASE("a limit admits both counts up to itself") {
  const SizeLimit limit{.contacts = 3, .with_friction = 1};
  CHECK_FALSE(limit.none());
  CHECK(limit.admits(with({})));
  CHECK(limit.admits(with({0.0, 0.5, 0.0})));
  CHECK_FALSE(limit.admits(with({0.0, 0.0, 0.0, 0.0})));
  CHECK_FALSE(limit.admits(with({0.5, 0.5})));
}

TEST_CASE("no limit admits everything") {
  CHECK(SizeLimit{}.none());
  CHECK(SizeLimit{}.admits(with(std::vector<double>(5000, 0.5))));
}
