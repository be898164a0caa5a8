// Pair tests and manifolds by number of vertices.

#include <memory>

#include "experiments/bench/kernels.hpp"
#include "geometry/contact/axis_search.hpp"
#include "geometry/contact/contact_manifold.hpp"

namespace ballast {
namespace {

constexpr int pair_count = 64;

/// The whole way of a pair through the detector: pose, broad phase, axis, manifold.
struct DetectionWork {
  GrainPairs pairs;
  ContactDetector detector;
  std::vector<double> reach;
  std::vector<ContactPoint> contacts;
  size_t visit = 0;

  DetectionWork(int vertices, bool touching, bool cached)
      : pairs(grain_pairs(vertices, touching, pair_count)),
        detector(pairs.contact_shapes(), settings(pairs, cached)),
        reach(pairs.shapes.size(), pairs.reach) {}

  static DetectionSettings settings(const GrainPairs& pairs, bool cached) {
    DetectionSettings result;
    result.skin = pairs.skin;
    result.use_cache = cached;
    return result;
  }
  void next() { detector.detect(pairs.poses[visit++ % pairs.poses.size()], reach, contacts); }
};

/// Touching pairs with their axes known: clipping and reduction alone.
struct ManifoldWork {
  GrainPairs pairs;
  std::vector<CollisionShape> shapes;
  std::vector<ShapePair> tests;
  std::vector<SeparatingAxis> axes;
  ContactManifold manifold;
  size_t points = 0;

  explicit ManifoldWork(int vertices) : pairs(grain_pairs(vertices, true, pair_count)) {
    for (const auto& shape : pairs.shapes) shapes.emplace_back(*shape);
    AxisSearch search(shapes);
    for (int k = 0; k < pairs.count(); ++k) {
      const Pose &a = pairs.poses[0][2 * k], &b = pairs.poses[0][2 * k + 1];
      const Mat3 into_a = a.rotation.toRotationMatrix().transpose();
      const ShapePair pair(
          shapes[2 * k], shapes[2 * k + 1],
          {into_a * b.rotation.toRotationMatrix(), into_a * (b.position - a.position)});
      AxisFeature hint;
      SeparatingAxis axis;
      if (is_separated(search.find(pair, 2.0 * pairs.reach, hint, axis))) continue;
      tests.push_back(pair);
      axes.push_back(axis);
    }
  }
  void all() {
    for (size_t k = 0; k < tests.size(); ++k)
      points += manifold.points(tests[k], axes[k], 2.0 * pairs.reach, 4).size();
  }
};

}  // namespace

void add_detection_kernels(std::vector<Kernel>& kernels) {
  for (const int vertices : {8, 22, 37}) {
    const std::string suffix = ", " + std::to_string(vertices) + " vertices";
    for (const bool touching : {true, false})
      for (const bool cached : {false, true}) {
        const auto work = std::make_shared<DetectionWork>(vertices, touching, cached);
        kernels.push_back(
            {"pair",
             std::string(touching ? "touching" : "apart") + (cached ? " cached" : " cold") + suffix,
             "ns/pair", pair_count, [work] { work->next(); }});
      }
    const auto work = std::make_shared<ManifoldWork>(vertices);
    kernels.push_back({"manifold", "clip and reduce" + suffix, "ns/pair",
                       static_cast<double>(work->tests.size()), [work] { work->all(); }});
  }
}

}  // namespace ballast
