#pragma once
// The pace of a solver that is one of several ways to a solution (auto.hpp).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace ballast {

/// How fast one way's error has come down with its work.
class WorkPace {
 public:
  void begin() { points_.clear(); }
  void add(double work, double error) {
    if (!points_.empty()) error = std::min(error, points_.back().error);
    points_.push_back({work, error});
  }
  double error() const { return points_.empty() ? 1e300 : points_.back().error; }
  /// ln of the error per work, over the later half of the work; 0: it stands still.
  double rate() const {
    if (points_.empty()) return 0.0;
    const Point& last = points_.back();
    size_t k = points_.size() - 1;
    while (k > 0 && 2.0 * points_[k].work > last.work) --k;
    const double work = last.work - points_[k].work;
    return work > 0.0 && last.error > 0.0 ? std::log(points_[k].error / last.error) / work : 0.0;
  }
  /// Work to `aim` at that rate.
  double left(double aim) const {
    if (!(error() > aim)) return 0.0;
    const double pace = rate();
    return pace > 0.0 && aim > 0.0 ? std::log(error() / aim) / pace : 1e300;
  }

 private:
  struct Point {
    double work, error;
  };
  std::vector<Point> points_;
};

}  // namespace ballast
