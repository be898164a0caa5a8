#include "geometry/contact/broad_phase.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ballast {

Travel step_bound(const Pose& from, const Pose& to) {
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
  box.low += position;
  box.high += position;
  return box;
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
    // A list holds while each body, with its reach, is within the box that it was listed with.
    const Travel moved = step_bound(listed_pose_[i], poses[i]);
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
  for (const int i : order_) {
    const CollisionShape& shape = *bodies_[i].shape;
    // The margin beyond the reach is what a body may move before the list is made anew: a large one
    // makes few lists with many pairs, a small one the reverse.
    allowance_[i] += std::max(0.5 * skin_, std::min(8.0 * reach[i], shape.circumradius()));
    boxes_[i] = bounding_box(shape, rotations[i], poses[i].position);
    boxes_[i].low.array() -= allowance_[i];
    boxes_[i].high.array() += allowance_[i];
  }
}

/// Sort and prune, along the axis on which the bodies are spread out most: only boxes that overlap
/// along it are compared in the other two directions.
void BroadPhase::find_overlaps() {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  for (const int i : order_) {
    low = low.cwiseMin(boxes_[i].low);
    high = high.cwiseMax(boxes_[i].low);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  std::sort(order_.begin(), order_.end(), [&](int i, int j) {
    const double a = boxes_[i].low[axis], b = boxes_[j].low[axis];
    return a < b || (a == b && i < j);
  });
  // Each box against those after it, read in their order.
  const int directions[] = {axis, (axis + 1) % 3, (axis + 2) % 3};
  for (int d = 0; d < 3; ++d) {
    sorted_[d].clear();
    for (const int i : order_)
      sorted_[d].push_back({boxes_[i].low[directions[d]], boxes_[i].high[directions[d]]});
  }
  const auto overlaps = [](const Interval& p, const Interval& q) {
    return (q.low <= p.high) & (q.high >= p.low);
  };
  found_.clear();
  // Boxes in the order in which they begin along the axis:
  //
  //     i   |---------|
  //     j        |------|          begins before i ends: compared in the other directions
  //     k                 |---|    begins behind i's end, and so do all after it: i is done
  for (size_t k = 0; k < order_.size(); ++k) {
    const Interval along = sorted_[0][k], second = sorted_[1][k], third = sorted_[2][k];
    for (size_t l = k + 1; l < order_.size() && sorted_[0][l].low <= along.high; ++l) {
      if (!(overlaps(second, sorted_[1][l]) & overlaps(third, sorted_[2][l]))) continue;
      const int i = order_[k], j = order_[l];
      if (!bodies_[i].meets(bodies_[j])) continue;
      found_.emplace_back(std::min(i, j), std::max(i, j));
    }
  }
}

/// What has been found becomes the list. Both are sorted by (a, b): pairs that stay move to their
/// new places, with what is known of them.
void BroadPhase::list_pairs() {
  std::sort(found_.begin(), found_.end());
  auto next = found_.begin();
  std::erase_if(pairs_, [&](const CandidatePair& pair) {
    next = std::find_if(next, found_.end(), [key = std::pair(pair.a, pair.b)](const auto& found) {
      return found >= key;
    });
    return next == found_.end() || *next != std::pair(pair.a, pair.b);
  });
  std::fill(first_.begin(), first_.end(), 0);
  // From the end on, so that no pair is written over before it has moved.
  size_t stays = pairs_.size();
  pairs_.resize(found_.size());
  for (size_t k = found_.size(); k-- > 0;) {
    const auto [a, b] = found_[k];
    const bool is_old = stays > 0 && pairs_[stays - 1].a == a && pairs_[stays - 1].b == b;
    pairs_[k] = is_old ? pairs_[--stays] : CandidatePair{.a = a, .b = b};
    ++first_[a + 1];
  }
  for (size_t a = 0; a < bodies_.size(); ++a) first_[a + 1] += first_[a];
}

}  // namespace ballast
