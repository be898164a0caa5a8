#pragma once
// A world that repeats itself along one direction.

#include <cmath>

#include "geometry/shape/pose.hpp"

namespace ballast {

/// The world repeats itself after this vector [m]; zero: it does not. Positions count only up to
/// whole periods.
struct Period {
  Vec3 vector = Vec3::Zero();

  bool repeats() const { return !vector.isZero(0.0); }
  /// Whether a plane of this unit normal is the same plane one period on.
  bool keeps_plane(const Vec3& normal) const {
    return std::abs(normal.dot(vector)) <= 1e-9 * vector.norm();
  }
  /// Whether a body of this circumradius [m] is smaller than half a period, so that it meets
  /// another body on one side only, and its nearest image is the one that is touched.
  bool has_room_for(double circumradius) const {
    return !repeats() || 4.0 * circumradius < vector.norm();
  }
  /// The image of x that lies in the first period, 0 <= x.P / P.P < 1.
  Vec3 wrapped(const Vec3& x) const { return repeats() ? Vec3(x - periods(x, 0.0)) : x; }
  /// The vector that differs from x by whole periods and is shortest along the period.
  Vec3 nearest(const Vec3& x) const { return repeats() ? Vec3(x - periods(x, 0.5)) : x; }

 private:
  Vec3 periods(const Vec3& x, double ahead) const {
    return std::floor(x.dot(vector) / vector.squaredNorm() + ahead) * vector;
  }
};

}  // namespace ballast
