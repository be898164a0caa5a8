#pragma once
// The two matrices of a contact between bodies, for problems that are made and not detected.

#include <Eigen/Dense>

namespace ballast {

/// The matrix of x cross: cross_matrix(x) y = x.cross(y).
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& x) {
  Eigen::Matrix3d cross;
  cross << 0, -x[2], x[1], x[2], 0, -x[0], -x[1], x[0], 0;
  return cross;
}

/// Rows n, t1, t2 of a right-handed frame: n a unit vector, t1 across n and `other`, which must not
/// be parallel to n.
inline Eigen::Matrix3d contact_frame(const Eigen::Vector3d& n, const Eigen::Vector3d& other) {
  const Eigen::Vector3d t1 = n.cross(other).normalized();
  Eigen::Matrix3d frame;
  frame << n.transpose(), t1.transpose(), n.cross(t1).transpose();
  return frame;
}

}  // namespace ballast
