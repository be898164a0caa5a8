#include "geometry/contact/broad_phase.hpp"

#include <algorithm>
#include <cmath>

namespace ballast {

MotionBound step_bound(const Pose& from, const Pose& to) {
  // Unit quaternions p and q of rotations that differ by phi have |p - q| = 2 sin(phi/4), where q
  // and -q are one rotation. A point at distance R moves along the chord 2 R sin(phi/2), which is
  // at most 2 R |p - q|.
  const double same = (to.rotation.coeffs() - from.rotation.coeffs()).squaredNorm();
  const double opposite = (to.rotation.coeffs() + from.rotation.coeffs()).squaredNorm();
  return {(to.position - from.position).norm(), 2.0 * std::sqrt(std::min(same, opposite))};
}

Bounds bounding_box(const CollisionShape& shape, const Mat3& rotation, const Vec3& position) {
  const AffineRows& vertices = shape.vertices();
  Bounds box{Vec3::Constant(1e300), Vec3::Constant(-1e300)};
  for (int v = 0; v < vertices.count(); ++v) {
    const Vec3 p = rotation * vertices.xyz(v);
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return {box.low + position, box.high + position};
}

BroadPhase::BroadPhase(std::vector<Body> bodies, double skin)
    : bodies_(std::move(bodies)), skin_(skin) {
  boxes_.resize(bodies_.size());
  for (size_t i = 0; i < bodies_.size(); ++i) {
    radius_.push_back(bodies_[i].shape ? bodies_[i].shape->circumradius() : 0.0);
    if (bodies_[i].shape) order_.push_back(static_cast<int>(i));
  }
  first_.assign(bodies_.size() + 1, 0);
}

void BroadPhase::update(std::span<const Pose> poses, std::span<const Mat3> rotations,
                        std::span<const double> reach) {
  if (still_valid(poses, reach)) return;
  list_boxes(poses, rotations, reach);
  find_overlaps();
  list_pairs();
  ++rebuilds_;
}

bool BroadPhase::still_valid(std::span<const Pose> poses, std::span<const double> reach) const {
  if (listed_pose_.empty()) return false;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i].shape) continue;
    const MotionBound moved = step_bound(listed_pose_[i], poses[i]);
    if (!(moved.shift + radius_[i] * moved.turn + reach[i] <= allowance_[i])) return false;
  }
  return true;
}

/// Fast bodies get a margin of several steps' reach, so that one of them does not cause a new list
/// in every step.
void BroadPhase::list_boxes(std::span<const Pose> poses, std::span<const Mat3> rotations,
                            std::span<const double> reach) {
  listed_pose_.assign(poses.begin(), poses.end());
  allowance_.assign(reach.begin(), reach.end());
  run_each(team_, static_cast<int>(order_.size()), /*together=*/64, [&](int k) {
    const int i = order_[k];
    const CollisionShape& shape = *bodies_[i].shape;
    // The margin beyond the reach is the way that a body may move before the list is made anew. A
    // large margin makes few lists with many pairs, a small one many lists with few pairs.
    allowance_[i] += std::max(0.5 * skin_, std::min(8.0 * reach[i], shape.circumradius()));
    boxes_[i] = bounding_box(shape, rotations[i], poses[i].position);
    boxes_[i].low.array() -= allowance_[i];
    boxes_[i].high.array() += allowance_[i];
  });
}

/// Sorts and prunes strip by strip: the boxes are put into strips across one direction, and within
/// a strip only boxes that overlap along another direction are compared.
void BroadPhase::find_overlaps() {
  if (order_.empty()) return;
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300), width = Vec3::Zero();
  for (const int i : order_) {
    low = low.cwiseMin(boxes_[i].low);
    high = high.cwiseMax(boxes_[i].low);
    width += (boxes_[i].high - boxes_[i].low) / static_cast<double>(order_.size());
  }
  // Boxes are sorted along the direction of the largest spread, in strips across the next one.
  int axis[] = {0, 1, 2};
  std::ranges::sort(axis, [spread = Vec3(high - low)](int i, int j) {
    return spread[i] > spread[j] || (spread[i] == spread[j] && i < j);
  });
  std::ranges::sort(order_, [&](int i, int j) {
    const double a = boxes_[i].low[axis[0]], b = boxes_[j].low[axis[0]];
    return a < b || (a == b && i < j);
  });
  const double first = low[axis[1]], spread = high[axis[1]] - first;
  const double most = static_cast<double>(order_.size()) / 64.0;
  const int count = 1 + static_cast<int>(std::min(most, spread / (2.0 * width[axis[1]])));
  const auto strip_of = [=](double at) {  // the first where the share is NaN
    const double share = (at - first) / spread;
    return share > 0.0 ? static_cast<int>(std::min(share, 1.0) * (count - 1)) : 0;
  };
  strips_.resize(count);
  for (Strip& strip : strips_) strip.bodies.clear();
  for (const int i : order_)
    for (int s = strip_of(boxes_[i].low[axis[1]]); s <= strip_of(boxes_[i].high[axis[1]]); ++s)
      strips_[s].bodies.push_back(i);
  run_parts(team_, count, [&](int s) {
    compare_boxes(strips_[s], axis, [&](double begin) { return strip_of(begin) == s; });
  });
}

/// Compares the boxes of a strip in the order in which they begin along axis[0]:
///
///     i   |---------|
///     j        |------|          begins before i ends: compared in the other directions
///     k                 |---|    begins behind i's end, and so do all after it: i is done
///
/// A pair is listed only in the strip in which its overlap along axis[1] begins: `is_here`.
template <class IsHere>
void BroadPhase::compare_boxes(Strip& strip, const int (&axis)[3], const IsHere& is_here) const {
  struct Interval {
    double low, high;
  };
  thread_local std::vector<Interval> sorted[3];  // the boxes along each direction
  for (int d = 0; d < 3; ++d) {
    sorted[d].clear();
    for (const int i : strip.bodies)
      sorted[d].push_back({boxes_[i].low[axis[d]], boxes_[i].high[axis[d]]});
  }
  const auto& [first, second, third] = sorted;
  strip.found.clear();
  const auto overlaps = [](const Interval& p, const Interval& q) {
    return (q.low <= p.high) & (q.high >= p.low);
  };
  for (size_t k = 0; k < first.size(); ++k)
    for (size_t l = k + 1; l < first.size() && first[l].low <= first[k].high; ++l) {
      if (!(overlaps(second[k], second[l]) & overlaps(third[k], third[l]))) continue;
      const int i = strip.bodies[k], j = strip.bodies[l];
      if (!bodies_[i].meets(bodies_[j]) || !is_here(std::max(second[k].low, second[l].low)))
        continue;
      strip.found.emplace_back(std::min(i, j), std::max(i, j));
    }
}

/// Makes the pairs found the list. Both are sorted by (a, b); pairs that stay keep their memory and
/// move to their new places.
void BroadPhase::list_pairs() {
  found_.clear();
  for (const Strip& strip : strips_)
    found_.insert(found_.end(), strip.found.begin(), strip.found.end());
  std::sort(found_.begin(), found_.end());
  size_t stays = 0;
  auto next = found_.begin();
  for (CandidatePair& pair : pairs_) {
    next = std::find_if(next, found_.end(), [key = std::pair(pair.a, pair.b)](const auto& found) {
      return found >= key;
    });
    if (next != found_.end() && *next == std::pair(pair.a, pair.b))
      pairs_[stays++] = pair;
    else if (pair.touching >= 0)
      vacant_.push_back(pair.touching);
  }
  std::fill(first_.begin(), first_.end(), 0);
  // Works from the end, so that no pair is overwritten before it has moved.
  pairs_.resize(found_.size());
  for (size_t k = found_.size(); k-- > 0;) {
    const auto [a, b] = found_[k];
    const bool is_old = stays > 0 && pairs_[stays - 1].a == a && pairs_[stays - 1].b == b;
    pairs_[k] = is_old ? pairs_[--stays] : CandidatePair{.a = a, .b = b};
    ++first_[a + 1];
  }
  for (size_t a = 0; a < bodies_.size(); ++a) first_[a + 1] += first_[a];
  // Reserves room for all pairs and for longer lists, though only half of them touch: pages that
  // are never written take no memory, and memories must not move before the next list.
  if (pairs_.size() <= memories_.capacity()) return;
  const size_t room = pairs_.size() + pairs_.size() / 2;
  memories_.reserve(room);
  vacant_.reserve(room);
}

int BroadPhase::new_place() {
  const std::lock_guard lock(place_mutex_);
  if (vacant_.empty()) {
    memories_.emplace_back();
    return static_cast<int>(memories_.size()) - 1;
  }
  const int place = vacant_.back();
  vacant_.pop_back();
  return place;
}

}  // namespace ballast
