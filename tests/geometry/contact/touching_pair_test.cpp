// The memory of a touching pair against the tables of its shapes.

#include "geometry/contact/touching_pair.hpp"
#include "geometry/contact/axis_search.hpp"
#include "geometry/contact/contact_manifold.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

constexpr double alert = 1e-4;
constexpr int all_points = 1 << 20;

/// Turns the pose by 10^-7 .. 10^-3 rad and shifts it by as many metres. `chord` bounds the turn as
/// in the detector.
RelativePose jiggled(const RelativePose& pose, Random& random, double& chord) {
  const double angle = std::abs(random_scale(random, 7.0, 3.0));
  const Vec3 axis = random_rotation(random) * Vec3::UnitX(),
             shift = random_scale(random, 7.0, 3.0) * axis;
  chord = angle;
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix() * pose.rotation, pose.position + shift};
}

struct Known {
  AxisOutcome outcome;
  SeparatingAxis axis;
  std::vector<ManifoldPoint> points;
};
Known ask_tables(const ShapePair& pair, AxisFeature hint, const ManifoldLimits& limits) {
  static AxisSearch search(collision_pool());
  static ContactManifold manifold;
  Known known;
  known.outcome = search.find(pair, alert, hint, known.axis);
  if (is_separated(known.outcome)) return known;
  const auto points = manifold.points(pair, known.axis, limits);
  known.points.assign(points.begin(), points.end());
  return known;
}

bool same_point(const ManifoldPoint& p, const ManifoldPoint& q) {
  return p.key == q.key && p.position == q.position && p.gap == q.gap;
}

}  // namespace

TEST_CASE("a remembered pair says what the tables say, bit for bit, or nothing") {
  Random random(91);
  ContactManifold manifold;
  Heights heights(1024);
  int touching[4] = {}, several[4] = {}, apart = 0, undecided = 0;
  for (int i = 0; i < 40000; ++i) {
    const PairCase c = random_case(placements[i % std::size(placements)], random);
    const ManifoldLimits limits{alert, all_points, /*joint=*/i % 3 ? -1.0 : 1e-2};
    const Known before = ask_tables(c.pair(), {}, limits);
    if (is_separated(before.outcome)) continue;
    TouchingPair remembered;
    remembered.record(c.pair(), before.axis, 3.0, heights);
    double chord = 0.0;
    const PairCase moved{c.a, c.b, jiggled(c.b_in_a, random, chord)};
    const auto [look, axis, points] = remembered.look(moved.pair(), 3.0 + chord, limits, manifold);
    const Known after = ask_tables(moved.pair(), before.axis.feature, limits);
    const Known fresh = ask_tables(moved.pair(), {}, limits);
    if (look == TouchingPair::PairOutcome::undecided) {
      ++undecided;
    } else if (look == TouchingPair::PairOutcome::apart) {
      ++apart;
      if (after.outcome != AxisOutcome::separated_by_hint ||
          after.axis.separation != axis.separation)
        FAIL_CHECK("case " << i << ": not apart");
    } else {
      ++touching[static_cast<int>(before.axis.feature.kind)];
      several[static_cast<int>(before.axis.feature.kind)] += points.size() > 1;
      for (const Known& known : {after, fresh}) {
        const bool same =
            !is_separated(known.outcome) && std::ranges::equal(known.points, points, same_point) &&
            known.axis.direction == axis.direction && known.axis.feature == axis.feature &&
            axis.clearance <= known.axis.clearance * (1.0 + 1e-12);
        if (!same) FAIL_CHECK("case " << i << ": another manifold");
      }
    }
  }
  CHECK(touching[static_cast<int>(AxisKind::face_of_a)] > 400);
  CHECK(touching[static_cast<int>(AxisKind::face_of_b)] > 400);
  CHECK(touching[static_cast<int>(AxisKind::edges)] > 1000);
  for (const AxisKind kind : {AxisKind::face_of_a, AxisKind::face_of_b, AxisKind::edges})
    CHECK(several[static_cast<int>(kind)] > 100);
  CHECK(apart > 300);
  CHECK(undecided > 500);
}
