#include "geometry/shape/plane_bundles.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "geometry/shape/front_search.hpp"

namespace ballast {
namespace {

/// Planes are taken together while this many pairs of a plane and a point at most are left to be
/// looked at one by one; otherwise their bundle is halved.
constexpr size_t most_pairs = 8192;

class PlaneBundles {
 public:
  PlaneBundles(std::span<const Vec3> points, std::span<const int> on, std::span<const Vec3> normals,
               std::span<const double> allowed)
      : points_(points), on_(on), normals_(normals), allowed_(allowed), search_(points) {
    planes_.resize(normals.size());
    std::iota(planes_.begin(), planes_.end(), 0);
  }

  int first() {
    std::vector<std::span<int>> left{planes_};
    while (!left.empty()) {
      std::span<int> bundle = left.back();
      left.pop_back();
      // Only what comes before the first that was found so far is of interest.
      if (found_ >= 0)
        bundle = {bundle.begin(),
                  std::partition(bundle.begin(), bundle.end(), [&](int f) { return f < found_; })};
      if (bundle.empty() || is_done(bundle)) continue;
      const size_t half = split(bundle);
      left.push_back(bundle.subspan(half));
      left.push_back(bundle.first(half));
    }
    return found_;
  }

 private:
  const Vec3& origin(int f) const { return points_[static_cast<size_t>(on_[idx(f)])]; }
  const Vec3& normal(int f) const { return normals_[idx(f)]; }
  static size_t idx(int f) { return static_cast<size_t>(f); }

  /// With h = normal.(centre - origin) for a plane of the bundle, m the mean normal, and p any
  /// point:
  /// normal.(p - origin) <= m.(p - centre) + |normal - m| |p - centre| + h.
  FrontSearch::Cone around(std::span<const int> bundle) const {
    // Of a few roundings, relative to the lengths: each side of the inequality has less.
    constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();
    FrontSearch::Cone cone{Vec3::Zero(), origin(bundle[0]), 0.0, 0.0};
    for (const int f : bundle) cone.normal += normal(f) / static_cast<double>(bundle.size());
    cone.height = std::numeric_limits<double>::infinity();
    for (const int f : bundle) {
      const Vec3 arm = cone.origin - origin(f);
      cone.spread = std::max(cone.spread, (normal(f) - cone.normal).norm());
      cone.height =
          std::min(cone.height, allowed_[idx(f)] - normal(f).dot(arm) - rounding * arm.norm());
    }
    cone.spread += rounding;
    return cone;
  }

  /// Whether the planes of the bundle have been answered for; false: they are too many at once.
  bool is_done(std::span<const int> bundle) {
    in_front_.clear();
    const size_t most = bundle.size() == 1 ? points_.size() : most_pairs / bundle.size();
    search_.visit_in_front(around(bundle), [&](int i) {
      in_front_.push_back(points_[idx(i)]);
      return in_front_.size() <= most;
    });
    if (in_front_.size() > most) return false;
    for (const int f : bundle) {
      if (found_ >= 0 && f > found_) continue;
      const Vec3 &n = normal(f), &o = origin(f);
      double highest = -std::numeric_limits<double>::infinity();
      for (const Vec3& p : in_front_) highest = std::max(highest, n.dot(p - o));
      if (highest > allowed_[idx(f)]) found_ = f;
    }
    return true;
  }

  /// Puts those planes first whose normals lie in the lower half of the widest axis; returns how
  /// many. Half of them where all normals are the same.
  size_t split(std::span<int> bundle) const {
    Vec3 low = normal(bundle[0]), high = low;
    for (const int f : bundle) {
      low = low.cwiseMin(normal(f));
      high = high.cwiseMax(normal(f));
    }
    Eigen::Index axis;
    (high - low).maxCoeff(&axis);
    const double middle = 0.5 * (low[axis] + high[axis]);
    const auto upper = std::partition(bundle.begin(), bundle.end(),
                                      [&](int f) { return normal(f)[axis] < middle; });
    const auto half = static_cast<size_t>(upper - bundle.begin());
    return half > 0 && half < bundle.size() ? half : bundle.size() / 2;
  }

  std::span<const Vec3> points_;
  std::span<const int> on_;
  std::span<const Vec3> normals_;
  std::span<const double> allowed_;
  FrontSearch search_;
  std::vector<int> planes_;
  std::vector<Vec3> in_front_;
  int found_ = -1;
};

}  // namespace

int first_plane_with_front(std::span<const Vec3> points, std::span<const int> on,
                           std::span<const Vec3> normals, std::span<const double> allowed) {
  return PlaneBundles(points, on, normals, allowed).first();
}

}  // namespace ballast
