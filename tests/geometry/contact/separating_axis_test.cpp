#include "geometry/contact/separating_axis.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/contact/axis_search.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"
#include "tests/geometry/shape/support_vertex.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

/// Every face of both bodies, and every pair of edges.
std::vector<AxisFeature> all_features(const ShapePair& pair) {
  std::vector<AxisFeature> features;
  const CollisionShape &a = *pair.shape[0], &b = *pair.shape[1];
  for (int f = 0; f < a.faces().count(); ++f) features.push_back({AxisKind::face_of_a, f, -1});
  for (int f = 0; f < b.faces().count(); ++f) features.push_back({AxisKind::face_of_b, -1, f});
  for (int ea = 0; ea < a.edge_count(); ++ea)
    for (int eb = 0; eb < b.edge_count(); ++eb) features.push_back({AxisKind::edges, ea, eb});
  return features;
}

int top_face(const CollisionShape& shape) {
  int best = 0;
  for (int f = 0; f < shape.faces().count(); ++f)
    if (shape.faces().xyz(f).z() > shape.faces().xyz(best).z()) best = f;
  return best;
}

}  // namespace

TEST_CASE("a face's separation is the gap to the other body's nearest vertex") {
  const CollisionShape box(make_box(Vec3(2, 2, 2)));
  Heights heights(512);
  // A cube on its corner above the top face, off centre.
  const Mat3 corner_down = turned_onto(Vec3(1, 1, 1), Vec3(0, 0, -1)).toRotationMatrix();
  const ShapePair pair(box, box, {corner_down, Vec3(0.3, -0.2, 1.0 + std::sqrt(3.0) - 0.01)});
  const auto axis = evaluate_axis(pair, {AxisKind::face_of_a, top_face(box), -1}, heights);
  REQUIRE(axis);
  CHECK(axis->separation == Approx(-0.01).epsilon(1e-12));
  CHECK(axis->direction.isApprox(Vec3(0, 0, 1)));
  CHECK(box.vertices().xyz(axis->support).isApprox(Vec3(1, 1, 1)));
  CHECK(axis->inside == Approx(0.7).epsilon(1e-12));
  CHECK(axis->clearance == Approx(2.0 / std::sqrt(3.0)).epsilon(1e-12));
  CHECK(is_proved_best(pair, face_isolation(pair, axis->feature), *axis));
}

TEST_CASE("crossed edges: the gap along their common normal") {
  // Two square rods, turned by 45 degrees about their axes, cross edge over edge at 60 degrees.
  const CollisionShape rod(make_box(Vec3(10, 1, 1)));
  const Mat3 on_edge = Eigen::AngleAxisd(0.25 * std::acos(-1.0), Vec3::UnitX()).toRotationMatrix();
  const Mat3 cross = Eigen::AngleAxisd(std::acos(0.5), Vec3::UnitZ()).toRotationMatrix();
  const RelativePose b_in_a{on_edge.transpose() * cross * on_edge,
                            on_edge.transpose() * Vec3(0.0, 0.0, std::sqrt(2.0) + 0.02)};
  const ShapePair pair(rod, rod, b_in_a);
  Heights heights(512);
  std::vector<SeparatingAxis> found;
  for (const AxisFeature& feature : all_features(pair)) {
    const auto axis = evaluate_axis(pair, feature, heights);
    if (axis && axis->separation > 0.0) found.push_back(*axis);
  }
  REQUIRE(found.size() == 1);
  CHECK(found[0].feature.kind == AxisKind::edges);
  CHECK(found[0].separation == Approx(0.02).epsilon(1e-12));
  CHECK(found[0].direction.isApprox(on_edge.transpose() * Vec3::UnitZ(), 1e-14));
  CHECK(found[0].inside == Approx(5.0 * std::sqrt(0.75)).epsilon(1e-12));
  CHECK(is_proved_best(pair, face_isolation(pair, found[0].feature), found[0]));
  CHECK(found[0].at_a == Approx(0.5));
  CHECK(found[0].at_b == Approx(0.5));
  // The nearest other vertices are on the rods' side edges, half a diagonal below.
  CHECK(found[0].clearance > 0.1);
  CHECK(found[0].clearance <= std::sqrt(0.5));
}

TEST_CASE("two edges form a facet exactly if both are supports along their common normal") {
  Random random(11);
  Heights heights(512);
  int facets = 0;
  for (int i = 0; i < 300; ++i) {
    const PairCase c = random_case(i % 2 ? Placement::deep : Placement::near_touching, random);
    const ShapePair pair = c.pair();
    const CollisionShape &a = *pair.shape[0], &b = *pair.shape[1];
    const Polyhedron &poly_a = shape_pool()[c.a], &poly_b = shape_pool()[c.b];
    for (int ea = 0; ea < a.edge_count(); ++ea) {
      for (int eb = 0; eb < b.edge_count(); ++eb) {
        const Vec3 along_b = c.b_in_a.rotation * b.edge(eb).along;
        const Vec3 cross = a.edge(ea).along.cross(along_b);
        if (cross.norm() < 1e-3 * a.edge(ea).along.norm() * along_b.norm()) continue;
        double worst_margin = -1.0;  // the larger support margin of the two directions
        for (double sign : {1.0, -1.0}) {
          const Vec3 n = sign * cross.normalized(), n_b = -(c.b_in_a.rotation.transpose() * n);
          const double lacks_a =
              n.dot(support_vertex(poly_a, n) - a.vertices().xyz(a.edge(ea).tail));
          const double lacks_b =
              n_b.dot(support_vertex(poly_b, n_b) - b.vertices().xyz(b.edge(eb).tail));
          worst_margin = std::max(worst_margin, -std::max(lacks_a, lacks_b));
        }
        if (std::abs(worst_margin) < 1e-10 && worst_margin < -1e-15) continue;  // too close to tell
        const bool is_facet = edge_separation(pair, ea, eb, heights).has_value();
        facets += is_facet;
        if (is_facet != (worst_margin > -1e-12))
          FAIL_CHECK("case " << i << ", edges " << ea << ", " << eb);
      }
    }
  }
  CHECK(facets > 5000);
}

TEST_CASE("an axis proved to be the best is the best") {
  Random random(13);
  Heights heights(512);
  int proved = 0, of_touching = 0, touching = 0;
  for (int i = 0; i < 3000; ++i) {
    const Placement placement = placements[i % std::size(placements)];
    const PairCase c = random_case(placement, random);
    const ShapePair pair = c.pair();
    double oracle = NAN;
    bool best_proved = false;
    for (const AxisFeature& feature : all_features(pair)) {
      const auto axis = evaluate_axis(pair, feature, heights);
      if (!axis || !is_proved_best(pair, face_isolation(pair, axis->feature), *axis)) continue;
      if (std::isnan(oracle))
        oracle = brute_force(shape_pool()[c.a], shape_pool()[c.b], c.b_in_a).facets;
      ++proved;
      best_proved = true;
      if (std::abs(axis->separation - oracle) > 1e-12 * c.size())
        FAIL_CHECK(name(placement)
                   << " case " << i << ": " << axis->separation << " is not " << oracle);
    }
    if (placement != Placement::near_touching) continue;
    ++touching;
    of_touching += best_proved;
  }
  CHECK(proved > 500);
  CHECK(of_touching > touching / 2);
}
