// Finds the islands of a problem.

#include <algorithm>
#include <numeric>
#include <utility>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

std::vector<std::vector<int>> contact_islands(const FrictionProblem& problem) {
  const DynamicsForm& dynamics = problem.dynamics;
  // Sets of bodies, each named by its smallest member: parent[b] <= b.
  std::vector<int> parent(dynamics.body_count());
  std::iota(parent.begin(), parent.end(), 0);
  const auto set_of = [&](int b) {
    while (parent[b] != b) b = parent[b] = parent[parent[b]];  // halves the path for the next call
    return b;
  };
  for (int c = 0; c < problem.contact_count(); ++c) {
    if (dynamics.body_a[c] < 0 || dynamics.body_b[c] < 0) continue;
    int low = set_of(dynamics.body_a[c]), high = set_of(dynamics.body_b[c]);
    if (low > high) std::swap(low, high);
    parent[high] = low;
  }
  std::vector<std::vector<int>> of_set(dynamics.body_count()), islands;
  for (int c = 0; c < problem.contact_count(); ++c)
    if (const int body = std::max(dynamics.body_a[c], dynamics.body_b[c]); body >= 0)
      of_set[set_of(body)].push_back(c);
  for (std::vector<int>& contacts : of_set)
    if (!contacts.empty()) islands.push_back(std::move(contacts));
  return islands;
}

}  // namespace ballast
