#pragma once
// Things put in the order of small whole numbers, in linear time: half-edges by their vertex, faces
// by their patch.

#include <span>
#include <vector>

namespace ballast {

/// Positions of keys, by key: those of key k are order[begin[k]] to before order[begin[k + 1]],
/// ascending.
struct SortedByKey {
  std::vector<int> begin, order;

  std::span<const int> of(int key) const {
    return {order.data() + begin[key], static_cast<size_t>(begin[key + 1] - begin[key])};
  }
};

/// `keys`: each from 0 to before `key_count`.
inline SortedByKey sorted_by_key(std::span<const int> keys, int key_count) {
  SortedByKey sorted;
  // Counted and summed up: where each key's positions begin.
  sorted.begin.assign(static_cast<size_t>(key_count) + 1, 0);
  for (const int key : keys) ++sorted.begin[key + 1];
  for (int k = 0; k < key_count; ++k) sorted.begin[k + 1] += sorted.begin[k];
  std::vector<int> next(sorted.begin.begin(), sorted.begin.end() - 1);
  sorted.order.resize(keys.size());
  for (size_t i = 0; i < keys.size(); ++i) sorted.order[next[keys[i]]++] = static_cast<int>(i);
  return sorted;
}

}  // namespace ballast
