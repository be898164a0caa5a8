// Islands: the search for components against a slow, simple one.

#include <algorithm>

#include "problems/algebra/known_solutions.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The slow, simple way: every body takes the smaller label of its neighbours until nothing
/// changes.
std::vector<int> labels_of(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  std::vector<int> label(dynamics.body_count());
  for (int b = 0; b < dynamics.body_count(); ++b) label[b] = b;
  for (bool changed = true; changed;) {
    changed = false;
    for (int c = 0; c < problem.contact_count(); ++c) {
      const int a = dynamics.body_a[c], b = dynamics.body_b[c];
      if (a < 0 || b < 0 || label[a] == label[b]) continue;
      label[a] = label[b] = std::min(label[a], label[b]);
      changed = true;
    }
  }
  return label;
}

}  // namespace

TEST_CASE("islands are the ones that the slow obvious search finds, each contact once") {
  int several = 0, immovable = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const int bodies = 1 + static_cast<int>(seed % 30), contacts = static_cast<int>(seed * 7 % 40);
    FrictionProblem problem =
        make_known_solution({.bodies = bodies, .contacts = contacts, .seed = seed}).problem;
    if (contacts > 0) problem.dynamics.body_a[0] = problem.dynamics.body_b[0] = -1;
    const std::vector<int> label = labels_of(problem);
    // Sorted by label, which is the first body of the island.
    std::vector<std::vector<int>> by_label(bodies), expected;
    for (int c = 0; c < contacts; ++c) {
      const int body = std::max(problem.dynamics.body_a[c], problem.dynamics.body_b[c]);
      body < 0 ? void(++immovable) : by_label[label[body]].push_back(c);
    }
    std::copy_if(by_label.begin(), by_label.end(), std::back_inserter(expected),
                 [](const auto& island) { return !island.empty(); });
    CHECK(contact_islands(problem) == expected);
    several += expected.size() > 1;
  }
  CHECK(several > 10);
  CHECK(immovable > 10);
}
