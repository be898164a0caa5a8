#pragma once
// Position and orientation of a rigid body, and how they move; a world that repeats itself.

#include <Eigen/Dense>
#include <cmath>

#include "platform/random.hpp"

namespace ballast {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

/// Pose of a body frame B in the world frame W: x_W = position + rotation * x_B.
/// The body frame of every grain sits at its centre of mass, along its principal axes of inertia.
struct Pose {
  Vec3 position = Vec3::Zero();      ///< centre of mass in W [m]
  Quat rotation = Quat::Identity();  ///< R_WB as a unit quaternion

  Vec3 operator*(const Vec3& p_B) const { return position + rotation * p_B; }
};

/// The pose in W of a frame that has the pose `inner` in the frame of `outer`; normalised.
inline Pose composed(const Pose& outer, const Pose& inner) {
  return {outer * inner.position, (outer.rotation * inner.rotation).normalized()};
}

/// exp(phi/2): the rotation by |phi| [rad] around phi, exact to rounding at every size of phi.
inline Quat rotation_by(const Vec3& phi) {
  const double angle_sq = phi.squaredNorm();
  const double half = 0.5 * std::sqrt(angle_sq);
  // sin(half)/(2 half) by its series below 1e-4 rad, where the quotient would lose digits
  const double s = half < 1e-4 ? 0.5 * (1.0 - half * half / 6.0) : 0.5 * std::sin(half) / half;
  return Quat(std::cos(half), s * phi.x(), s * phi.y(), s * phi.z());
}

/// Moves a pose for `dt` [s] at velocity v_W [m/s] (world frame) and angular velocity w_B [rad/s]
/// (body frame): the exponential map, then normalised, so that the quaternion's length does not
/// drift.
inline Pose moved(const Pose& pose, const Vec3& v_W, const Vec3& w_B, double dt) {
  return {pose.position + dt * v_W, (pose.rotation * rotation_by(dt * w_B)).normalized()};
}

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

// Directions and rotations by the seeded generator: products and square roots only, so that they
// too are the same on every machine.

/// A unit vector, uniform on the sphere (rejection from the cube).
inline Vec3 random_direction(Random& random) {
  while (true) {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0),
                 z = random.uniform(-1.0, 1.0);
    const double length_sq = x * x + y * y + z * z;
    if (length_sq <= 1.0 && length_sq > 1e-6) return Vec3(x, y, z) / std::sqrt(length_sq);
  }
}

/// A rotation, uniform over all of them (rejection in four dimensions).
inline Quat random_rotation(Random& random) {
  while (true) {
    const double w = random.uniform(-1.0, 1.0), x = random.uniform(-1.0, 1.0),
                 y = random.uniform(-1.0, 1.0), z = random.uniform(-1.0, 1.0);
    const double length_sq = w * w + x * x + y * y + z * z;
    if (length_sq > 1.0 || length_sq < 1e-6) continue;
    const double length = std::sqrt(length_sq);
    return Quat(w / length, x / length, y / length, z / length);
  }
}

}  // namespace ballast
