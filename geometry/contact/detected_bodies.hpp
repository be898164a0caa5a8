#pragma once
// The bodies as a detection finds them: shapes, poses, and how far each has moved.

#include <span>
#include <vector>

#include "geometry/contact/broad_phase.hpp"
#include "geometry/contact/contact_shape.hpp"

namespace ballast {

/// Read by all parts of a detection, written only between detections.
struct DetectedBodies {
  /// `reuse_motion` > 0: points are held on to while bodies move by less than this part of their
  /// circumradii (DetectionSettings).
  DetectedBodies(std::vector<ContactShape> bodies, double reuse_motion);

  /// The poses and reaches of this call; both must outlive it.
  void take(std::span<const Pose> new_poses, std::span<const double> new_reach);

  int count() const { return static_cast<int>(shapes.size()); }
  /// Null for a plane.
  const CollisionShape* shape(int body) const {
    return table_of[body] < 0 ? nullptr : &tables[table_of[body]];
  }
  bool holds() const { return !margin.empty(); }

  std::vector<ContactShape> shapes;
  std::vector<CollisionShape> tables;  ///< one per distinct polyhedron, in the order of first use
  std::vector<int> table_of;           ///< of each body; -1 for planes
  std::vector<BodyBounds> bounds;      ///< of all bodies, in one place; zero for planes
  std::vector<double> margin;  ///< how far each body may move while points are held on to [m];
                               ///< empty: they are not

  std::span<const Pose> poses;          ///< of this call
  std::vector<Mat3> rotations;          ///< R_WB at these poses
  std::span<const double> given_reach;  ///< of this call [m]
  std::span<const double> reach;        ///< the same, with the margins where points are held on to
  std::vector<Travel> travel;           ///< since the first call

 private:
  std::vector<Pose> previous_;      // poses of the last call
  std::vector<double> wide_reach_;  // given_reach + margin
};

}  // namespace ballast
