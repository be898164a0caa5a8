#include "geometry/contact/axis_search.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

AxisFeature random_feature(const ShapePair& pair, Random& random) {
  const int edges_a = pair.shape[0]->edge_count();
  const int edges_b = pair.shape[1]->edge_count();
  switch (random.below(3)) {
    case 0:
      return {AxisKind::face_of_a, random.below(pair.shape[0]->faces().count()), -1};
    case 1:
      return {AxisKind::face_of_b, -1, random.below(pair.shape[1]->faces().count())};
    default:
      return {AxisKind::edges, random.below(edges_a), random.below(edges_b)};
  }
}

bool same_bits(const SeparatingAxis& p, const SeparatingAxis& q) {
  return p.feature == q.feature && p.support == q.support && p.separation == q.separation &&
         p.direction == q.direction && p.inside == q.inside && p.clearance == q.clearance;
}

}  // namespace

TEST_CASE("the separation is the oracle's, over all placements") {
  AxisSearch search(collision_pool());
  for (const Placement placement : placements) {
    Random random(1000 + static_cast<int>(placement));
    double worst = 0.0;
    int overlapping = 0, faces = 0;
    const int count = 4000;
    for (int i = 0; i < count; ++i) {
      const PairCase c = random_case(placement, random);
      AxisFeature hint;
      SeparatingAxis axis;
      search.find(c.pair(), 1e9, hint, axis);
      const BruteForce oracle = brute_force(shape_pool()[c.a], shape_pool()[c.b], c.b_in_a);
      // For separated bodies, cross products that are no facets may give a larger gap, up to the
      // distance. For overlapping bodies none does.
      double error = std::abs(axis.separation - oracle.facets);
      if (oracle.all <= 0.0) error = std::max(error, std::abs(axis.separation - oracle.all));
      overlapping += oracle.all <= 0.0;
      faces += axis.feature.kind != AxisKind::edges;
      worst = std::max(worst, error / c.size());
      if (error > 1e-12 * c.size())
        FAIL_CHECK(name(placement)
                   << " case " << i << ": shapes " << c.a << ", " << c.b << " " << axis.separation
                   << " instead of " << oracle.facets << " / " << oracle.all);
      if (std::abs(oracle.all) > 1e-12 * c.size() && (oracle.all > 0.0) != (axis.separation > 0.0))
        FAIL_CHECK(name(placement) << " case " << i << ": wrong sign");
    }
    INFO(name(placement) << ": overlapping " << overlapping << ", faces " << faces << " of "
                         << count);
    CHECK(worst <= 1e-12);
    if (placement == Placement::near_touching) {
      CHECK((overlapping > count / 4 && overlapping < 3 * count / 4));
      CHECK((faces > count / 10 && faces < 9 * count / 10));
    }
    if (placement == Placement::deep || placement == Placement::inside)
      CHECK(overlapping > count / 2);
  }
}

TEST_CASE(
    "edges closer to parallel than the threshold cost no more than the sliver they leave out") {
  // The facet left out is parallel_sine of an edge wide; an axis beside it differs by that much.
  AxisSearch search(collision_pool());
  Random random(4);
  double worst = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const PairCase c = edges_together(std::pow(10.0, -random.uniform(7.0, 12.0)), random);
    AxisFeature hint;
    SeparatingAxis axis;
    search.find(c.pair(), 1e9, hint, axis);
    const BruteForce oracle = brute_force(shape_pool()[c.a], shape_pool()[c.b], c.b_in_a);
    if (oracle.all > 1e-7 * c.size())
      continue;  // separated: cross products that are no facets give more
    worst = std::max(worst, std::abs(oracle.all - axis.separation) / c.size());
  }
  CHECK(worst <= 1e-7);
}

TEST_CASE("outcome and axis do not depend on the hint") {
  AxisSearch search(collision_pool());
  Random random(2);
  int proved = 0, by_hint = 0;
  for (int i = 0; i < 20000; ++i) {
    const PairCase c = random_case(placements[i % std::size(placements)], random);
    const ShapePair pair = c.pair();
    const double alert = random.below(2) == 0 ? 1e9 : std::pow(10.0, -random.uniform(1.0, 6.0));
    AxisFeature best;
    SeparatingAxis reference;
    const bool apart = is_separated(search.find(pair, alert, best, reference));
    for (int k = 0; k < 6; ++k) {
      AxisFeature hint = k == 0 ? best : random_feature(pair, random);
      SeparatingAxis axis;
      const AxisOutcome outcome = search.find(pair, alert, hint, axis);
      if (k == 0) proved += outcome == AxisOutcome::proved_by_hint;
      by_hint += outcome == AxisOutcome::separated_by_hint;
      if (is_separated(outcome) != apart || (!apart && !same_bits(axis, reference))) {
        FAIL_CHECK("case " << i << ", hint " << k << ": " << axis.separation << " instead of "
                           << reference.separation << ", shapes " << c.a << " and " << c.b);
      }
    }
  }
  CHECK(proved > 3000);
  CHECK(by_hint > 1000);
}

TEST_CASE("far apart, where coordinates are rounded to more than the bodies' tolerances, too") {
  AxisSearch search(collision_pool());
  Random random(5);
  int differ = 0;
  for (int i = 0; i < 4000; ++i) {
    PairCase c = random_case(placements[i % std::size(placements)], random);
    c.b_in_a.position = random_direction(random) * c.size() * random.log_uniform(1e2, 1e6);
    AxisFeature best;
    SeparatingAxis reference;
    search.find(c.pair(), 1e9, best, reference);
    for (int k = 0; k < 6; ++k) {
      AxisFeature hint = random_feature(c.pair(), random);
      SeparatingAxis axis;
      search.find(c.pair(), 1e9, hint, axis);
      differ += !same_bits(axis, reference);
    }
  }
  CHECK(differ == 0);
}

TEST_CASE("a search that stops at the alert distance agrees with one that does not") {
  AxisSearch search(collision_pool());
  Random random(3);
  int apart = 0;
  for (int i = 0; i < 20000; ++i) {
    const PairCase c = random_case(i % 2 ? Placement::near_touching : Placement::apart, random);
    AxisFeature none, hint;
    SeparatingAxis full, axis;
    search.find(c.pair(), 1e9, none, full);
    const double delta = random_scale(random, 2, 10);
    if (delta == 0.0)
      continue;  // within the tie tolerance another axis may be just above the alert distance
    const double alert = full.separation + delta;
    const AxisOutcome outcome = search.find(c.pair(), alert, hint, axis);
    apart += is_separated(outcome);
    if (is_separated(outcome) != (full.separation > alert)) FAIL_CHECK("case " << i);
    if (is_separated(outcome)) {
      // The separation along the returned feature exceeds the alert distance.
      Heights heights(256);
      const auto evaluated = evaluate_axis(c.pair(), hint, heights);
      if (!evaluated || !(evaluated->separation > alert))
        FAIL_CHECK("case " << i << ": no separating feature");
    }
  }
  CHECK(apart > 5000);
  CHECK(apart < 15000);
}

TEST_CASE("equal axes: faces before edges, a before b, the smaller index") {
  const std::vector<CollisionShape> shapes{CollisionShape(make_box(Vec3(2, 2, 2)))};
  AxisSearch cubes(shapes);
  AxisFeature hint;
  SeparatingAxis axis;
  // Two aligned cubes: the top face of a and the bottom face of b tie.
  cubes.find(ShapePair(shapes[0], shapes[0], {Mat3::Identity(), Vec3(0.1, 0.2, 1.9)}), 1.0, hint,
             axis);
  CHECK(axis.feature.kind == AxisKind::face_of_a);
  CHECK(axis.direction.isApprox(Vec3(0, 0, 1), 1e-15));
  CHECK(axis.separation == Approx(-0.1).epsilon(1e-14));
  // Concentric cubes: all six faces of a tie with all of b.
  hint = {};
  cubes.find(ShapePair(shapes[0], shapes[0], {Mat3::Identity(), Vec3::Zero()}), 1.0, hint, axis);
  CHECK(axis.feature == AxisFeature{AxisKind::face_of_a, 0, -1});
  CHECK(axis.separation == Approx(-2.0).epsilon(1e-14));
}
