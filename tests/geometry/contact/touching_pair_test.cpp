// What is remembered of a touching pair against the shapes' tables, and the proof of a lone
// crossing against clipping.

#include "geometry/contact/touching_pair.hpp"
#include "geometry/contact/axis_search.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

constexpr double alert = 1e-4;
constexpr int all_points = 1 << 20;

/// A small turn and shift, of 10^-7 .. 10^-3 rad and as many metres. `chord` bounds the turn as the
/// detector does.
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
Known ask_tables(const ShapePair& pair, AxisFeature hint) {
  static AxisSearch search(collision_pool());
  static ContactManifold manifold;
  Known known;
  known.outcome = search.find(pair, alert, hint, known.axis);
  if (is_separated(known.outcome)) return known;
  const auto points = manifold.points(pair, known.axis, alert, all_points);
  known.points.assign(points.begin(), points.end());
  return known;
}

bool same_bits(const ManifoldPoint& p, const ManifoldPoint& q) {
  return p.key == q.key && p.position == q.position && p.gap == q.gap;
}

}  // namespace

TEST_CASE("a remembered pair says what the tables say, bit for bit, or nothing") {
  Random random(91);
  int touching[4] = {}, apart = 0, undecided = 0;
  for (int i = 0; i < 40000; ++i) {
    const PairCase c = random_case(kPlacements[i % std::size(kPlacements)], random);
    const Known before = ask_tables(c.pair(), {});
    if (is_separated(before.outcome)) continue;
    TouchingPair remembered;
    remembered.record(c.pair(), before.axis, 3.0);
    double chord = 0.0;
    const PairCase moved{c.a, c.b, jiggled(c.b_in_a, random, chord)};
    SeparatingAxis axis;
    ManifoldPoint point;
    const auto look = remembered.look(moved.pair(), 3.0 + chord, alert, axis, point);
    const Known after = ask_tables(moved.pair(), before.axis.feature);
    const Known fresh = ask_tables(moved.pair(), {});
    if (look == TouchingPair::Look::undecided) {
      ++undecided;
    } else if (look == TouchingPair::Look::apart) {
      ++apart;
      if (after.outcome != AxisOutcome::separated_by_hint ||
          after.axis.separation != axis.separation)
        FAIL_CHECK("case " << i << ": not apart");
    } else {
      ++touching[static_cast<int>(before.axis.feature.kind)];
      for (const Known& known : {after, fresh}) {
        const bool same = !is_separated(known.outcome) && known.points.size() == 1 &&
                          same_bits(known.points[0], point) && known.axis.normal == axis.normal &&
                          known.axis.feature == axis.feature &&
                          axis.clearance <= known.axis.clearance * (1.0 + 1e-12);
        if (!same) FAIL_CHECK("case " << i << ": another manifold");
      }
    }
  }
  CHECK(touching[static_cast<int>(AxisKind::face_of_a)] > 400);
  CHECK(touching[static_cast<int>(AxisKind::face_of_b)] > 400);
  CHECK(touching[static_cast<int>(AxisKind::edges)] > 1000);
  CHECK(apart > 300);
  CHECK(undecided > 500);
}

TEST_CASE("two flat edges whose faces rise out of reach: clipping finds their crossing alone") {
  Random random(92);
  FaceClipper clipper;
  int proved = 0, alone = 0;
  for (int i = 0; i < 60000; ++i) {
    const PairCase c = i % 3 ? edges_together(std::abs(random_scale(random, 1.5, 0.0)), random)
                             : random_case(Placement::near_touching, random);
    const ShapePair pair = c.pair();
    const Known known = ask_tables(pair, {});
    if (is_separated(known.outcome) || known.axis.feature.kind != AxisKind::edges) continue;
    const AxisFeature feature = known.axis.feature;
    const CollisionShape::Edge &a = pair.shape[0]->edges()[feature.a],
                               &b = pair.shape[1]->edges()[feature.b];
    const EdgeCrossing edges(pair, known.axis, a, b);
    if (edges.is_sharp()) continue;
    const int reference = edges.flat_on_a ? 0 : 1;
    const Vec3 direction =
        reference == 0 ? known.axis.normal : Vec3(-(pair.other[1].rotation * known.axis.normal));
    const auto corners = clipper.clip_along(
        pair, reference, reference == 0 ? edges.face_a : edges.face_b,
        reference == 0 ? edges.face_b : edges.face_a, direction, 1e-9 * c.size());
    const auto crossing = feature_key(PointKind::edges, feature.a, feature.b);
    int others = 0;
    for (const ClippedPoint& p : corners) others += p.key != crossing && p.height <= alert;
    alone += others == 0;
    if (!edges.rises_out_of_reach(pair, known.axis, a, b,
                                  sides_beside(*pair.shape[0], edges.face_a, feature.a),
                                  sides_beside(*pair.shape[1], edges.face_b, feature.b), alert))
      continue;
    ++proved;
    if (others > 0) FAIL_CHECK("case " << i << ": " << others << " other corners within reach");
  }
  CHECK(alone > 1000);
  CHECK(proved > alone / 2);  // the proof is worth having
}
