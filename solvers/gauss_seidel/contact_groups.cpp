#include "solvers/gauss_seidel/contact_groups.hpp"

#include <algorithm>

namespace ballast {

void ContactGroups::begin(int bodies) {
  lanes_.clear();
  fill_.clear();
  next_.clear();
  last_.assign(bodies, -1);
}

void ContactGroups::add(std::span<const int> contacts, std::span<const int> body_a,
                        std::span<const int> body_b) {
  const int begin = count();
  for (const int c : contacts) {
    const int a = body_a[c], b = body_b[c];
    // After both bodies' last groups; groups of earlier calls end before `begin`.
    int group = begin;
    if (a >= 0) group = std::max(group, last_[a] + 1);
    if (b >= 0) group = std::max(group, last_[b] + 1);
    group = first_with_room(group);
    lanes_[static_cast<size_t>(group) * group_lanes + fill_[group]] = c;
    if (++fill_[group] == group_lanes) next_[group] = group + 1;
    if (a >= 0) last_[a] = group;
    if (b >= 0) last_[b] = group;
  }
}

/// Full groups point onwards; what was walked past is pointed at the end of the walk.
int ContactGroups::first_with_room(int group) {
  // A union-find on groups: next_ leads towards one with room, and is shortened where it was
  // walked, so that a look-up takes nearly constant time however many groups are full.
  int end = group;
  while (end < count() && next_[end] != end) end = next_[end];
  if (end == count()) append_group();
  while (group != end) {
    const int onwards = next_[group];
    next_[group] = end;
    group = onwards;
  }
  return end;
}

void ContactGroups::append_group() {
  lanes_.insert(lanes_.end(), group_lanes, -1);
  next_.push_back(count());
  fill_.push_back(0);
}

}  // namespace ballast
