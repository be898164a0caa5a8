#pragma once
// The graph of bodies that touch, from which every matrix over bodies has its pattern.

#include <algorithm>
#include <utility>
#include <vector>

namespace ballast {

/// Everybody that each of `bodies` touches, itself among them, ascending. `pair(c)` are the bodies
/// of contact c; what is not in [0, bodies) does not move and touches nobody.
template <typename Pair>
std::vector<std::vector<int>> bodies_in_contact(int bodies, int contacts, const Pair& pair) {
  std::vector<std::vector<int>> near(bodies);
  for (int b = 0; b < bodies; ++b) near[b].push_back(b);
  const auto moves = [bodies](int body) { return body >= 0 && body < bodies; };
  for (int c = 0; c < contacts; ++c) {
    const std::pair<int, int> two = pair(c);
    if (!moves(two.first) || !moves(two.second)) continue;
    near[two.first].push_back(two.second);
    near[two.second].push_back(two.first);
  }
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

}  // namespace ballast
