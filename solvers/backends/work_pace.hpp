#pragma once
// Several ways to one solution, and the pace of each (auto.hpp).

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "solvers/seam/paused_solve.hpp"

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

/// One way to the solution, from an iterate of its own: where another way has come to misleads
/// accelerated sweeps more often than it helps them.
struct Way {
  std::unique_ptr<Solver> solver;
  /// It goes on from the best iterate where that is so much better than its own.
  double takes_best = 0.0;
  double trust = 2.0;  ///< it is taken to need at most so many times the work that it has had
  bool is_prepared = false;
  bool is_newton = false;
  bool only_factors = false;  ///< every iteration is a factorisation
  double work = 0.0;          ///< of an iteration
  double factorisation = 0;   ///< besides, of one that factors
  double expected = 0.0;      ///< work, as long as it has not shown its pace
  double spent = 0.0;         ///< work
  WorkPace pace;
  int stalls = 0;
  Impulses at;
  int factorisations = 0;              ///< of all its turns
  std::unique_ptr<PausedSolve> going;  ///< what it goes on with
};

}  // namespace ballast
