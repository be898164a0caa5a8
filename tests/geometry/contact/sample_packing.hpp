#pragma once
// A packing for tests of the detector.

#include <algorithm>

#include "geometry/contact/contact_detector.hpp"
#include "tests/geometry/contact/detection_support.hpp"

namespace ballast::testing {

/// Grains of the pool thrown into a box of six planes, one of them driven. A few grains are fixed.
struct Packing {
  Packing(int count, double side, std::uint64_t seed) : random(seed) {
    const int pool = static_cast<int>(shape_pool().size());
    for (int k = 0; k < 6; ++k) {
      ContactShape wall;
      wall.plane.normal = Vec3::Zero();
      wall.plane.normal[k % 3] = k < 3 ? 1.0 : -1.0;
      wall.fixed = k != 0;
      shapes.push_back(wall);
      Pose pose;
      pose.position[k % 3] = k < 3 ? 0.0 : side;
      poses.push_back(pose);
    }
    for (int i = 0; i < count; ++i) {
      shapes.push_back({&shape_pool()[random.below(pool)], {}, i % 9 == 4});
      Pose pose;
      pose.position =
          Vec3(random.uniform(0.0, side), random.uniform(0.0, side), random.uniform(0.0, side));
      pose.rotation = random_rotation(random);
      poses.push_back(pose);
    }
    std::swap(shapes[3], shapes[count]);  // a wall between the grains
    std::swap(poses[3], poses[count]);
    for (size_t i = 0; i < shapes.size(); ++i) {
      velocity.push_back(random_direction(random));
      reach.push_back(1e-5 + 1e-4 * random.uniform());
    }
  }
  /// Moves bodies apart along their contacts until they hardly overlap, as in the packing of a
  /// simulation.
  void relax() {
    ContactDetector detector(shapes, {});
    std::vector<ContactPoint> contacts;
    for (int round = 0; round < 400; ++round) {
      detector.detect(poses, reach, contacts);
      for (const ContactPoint& c : contacts) {
        const double depth = std::max(0.0, -c.gap);
        if (shapes[c.body_a].polyhedron && !shapes[c.body_a].fixed)
          poses[c.body_a].position -= 0.2 * depth * c.normal;
        if (!shapes[c.body_b].fixed) poses[c.body_b].position += 0.2 * depth * c.normal;
      }
    }
  }
  void move(double step) {
    for (size_t i = 0; i < shapes.size(); ++i) {
      if (shapes[i].fixed) continue;
      velocity[i] = (velocity[i] + 0.2 * random_direction(random)).normalized();
      if (shapes[i].polyhedron)
        poses[i] = moved(poses[i], velocity[i], 20.0 * velocity[i], step);
      else
        poses[i].position += step * velocity[i];
    }
  }
  Random random;
  std::vector<ContactShape> shapes;
  std::vector<Pose> poses;
  std::vector<double> reach;
  std::vector<Vec3> velocity;
};

inline bool same_bits(const std::vector<ContactPoint>& p, const std::vector<ContactPoint>& q) {
  return std::equal(
      p.begin(), p.end(), q.begin(), q.end(), [](const ContactPoint& a, const ContactPoint& b) {
        return a.body_a == b.body_a && a.body_b == b.body_b && a.feature == b.feature &&
               a.normal == b.normal && a.position == b.position && a.gap == b.gap;
      });
}

}  // namespace ballast::testing
