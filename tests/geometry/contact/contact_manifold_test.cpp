#include "geometry/contact/contact_manifold.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/contact/axis_search.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

/// Signed distance of a point in a's frame from the surface of body `which`, by the planes of its
/// faces (negative inside).
double height_over(const ShapePair& pair, int which, const Vec3& in_a) {
  const Vec3 p = which == 0 ? in_a : pair.other[1] * in_a;
  const AffineRows& faces = pair.shape[which]->faces();
  double most = -1e300;
  for (int f = 0; f < faces.count(); ++f) most = std::max(most, faces.xyz(f).dot(p) + faces.w(f));
  return most;
}

std::uint64_t mirrored_key(std::uint64_t key) {
  const std::uint64_t mask = 0x7fffffff, a = key >> 31 & mask, b = key & mask, kind = key >> 62;
  if (kind == 0) return feature_key(PointKind::vertex_of_a, static_cast<int>(b), 0);
  if (kind == 1) return feature_key(PointKind::vertex_of_b, 0, static_cast<int>(a));
  return feature_key(kind == 2 ? PointKind::edges : PointKind::sides, static_cast<int>(b),
                     static_cast<int>(a));
}

std::vector<Vec3> positions(const Contact& contact) {
  std::vector<Vec3> places;
  for (const ManifoldPoint& p : contact.points) places.push_back(p.position);
  return places;
}

/// The points of a plane, sorted by their angle around the normal as seen from their centre.
std::vector<Vec3> around(std::vector<Vec3> points, const Vec3& normal) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : points) centre += p / static_cast<double>(points.size());
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  std::sort(points.begin(), points.end(), [&](const Vec3& p, const Vec3& q) {
    return std::atan2(v.dot(p - centre), u.dot(p - centre)) <
           std::atan2(v.dot(q - centre), u.dot(q - centre));
  });
  return points;
}

/// Area of the convex hull of points in a plane, as a fan of triangles over the sorted polygon.
double hull_area(const std::vector<Vec3>& corners, const Vec3& normal) {
  const std::vector<Vec3> points = around(corners, normal);
  double area = 0.0;
  for (size_t k = 2; k < points.size(); ++k)
    area += 0.5 * normal.dot((points[k - 1] - points[0]).cross(points[k] - points[0]));
  return area;
}

}  // namespace

TEST_CASE(
    "every manifold: not empty, deepest point kept, points on both surfaces, keys sorted and "
    "unique") {
  int several = 0, fallbacks = 0, edge_pairs = 0, total = 0;
  for (const Placement placement : placements) {
    Random random(31 + static_cast<int>(placement));
    for (int i = 0; i < 3000; ++i) {
      const PairCase c = random_case(placement, random);
      const ShapePair pair = c.pair();
      const double alert = random.below(2) == 0 ? 0.0 : std::pow(10.0, -random.uniform(2.0, 7.0));
      const Contact found = contact_of(pair, alert);
      if (found.axis.separation > alert || found.points.empty()) {
        if (!found.points.empty() || found.axis.separation <= 0.0) {
          AxisFeature hint;
          SeparatingAxis axis;
          AxisSearch(collision_pool()).find(pair, 1e9, hint, axis);
          // within the tie tolerance another axis may be just above the alert distance
          if (axis.separation <= alert - 1e-13 * c.size())
            FAIL_CHECK(name(placement) << " case " << i << ": empty manifold");
        }
        continue;
      }
      ++total;
      several += found.points.size() > 1;
      const double small = 1e-9 * c.size();
      double least = 1e300;
      bool sorted = true, near_surfaces = true, within_reach = true;
      for (size_t k = 0; k < found.points.size(); ++k) {
        const ManifoldPoint& p = found.points[k];
        least = std::min(least, p.gap);
        sorted &= k == 0 || found.points[k - 1].key < p.key;
        within_reach &= p.gap <= alert + 1e-12 * c.size();
        const double over_a = height_over(pair, 0, p.position - 0.5 * p.gap * found.normal);
        const double over_b = height_over(pair, 1, p.position + 0.5 * p.gap * found.normal);
        if (found.axis.feature.kind == AxisKind::edges) {
          ++edge_pairs;
          near_surfaces &=
              found.axis.inside < 0.0 || (std::abs(over_a) <= small && std::abs(over_b) <= small);
        } else {
          // The point is always on the incident body's surface. It is within the reference face
          // unless it is the touching vertex.
          const bool a_is_reference = found.axis.feature.kind == AxisKind::face_of_a;
          const double reference = a_is_reference ? over_a : over_b,
                       incident = a_is_reference ? over_b : over_a;
          const bool fallback = reference > small;
          const auto touching = static_cast<std::uint64_t>(found.axis.support);
          fallbacks += fallback;
          near_surfaces &= std::abs(incident) <= small;
          near_surfaces &=
              !fallback || p.key == (a_is_reference ? touching : (touching << 31 | 1ull << 62));
        }
      }
      const bool deepest = std::abs(least - found.axis.separation) <= 1e-12 * c.size();
      if (!sorted || !near_surfaces || !within_reach || !deepest)
        FAIL_CHECK(name(placement)
                   << " case " << i << ": sorted " << sorted << ", on surfaces " << near_surfaces
                   << ", within reach " << within_reach << ", deepest " << deepest);
    }
  }
  CHECK(total > 8000);
  CHECK(several > 2000);
  CHECK(edge_pairs > 200);
  CHECK(fallbacks > 0);
}

TEST_CASE("swapping the bodies mirrors the manifold") {
  Random random(51);
  int compared = 0, ties = 0;
  for (int i = 0; i < 6000; ++i) {
    const Placement placement = placements[i % std::size(placements)];
    const PairCase c = random_case(placement, random);
    const ShapePair pair = c.pair(), swapped(*pair.shape[1], *pair.shape[0], c.b_in_a.inverse());
    const Contact found = contact_of(pair, 1e-4), other = contact_of(swapped, 1e-4);
    if (found.points.empty() != other.points.empty())
      FAIL_CHECK("case " << i << ": one of them is empty");
    if (found.points.empty()) continue;
    CHECK(std::abs(found.axis.separation - other.axis.separation) <= 1e-12 * c.size());
    // With equal axes the rule prefers body a, which is the other body here.
    if ((found.normal + c.b_in_a.rotation * other.normal).norm() > 1e-12 ||
        (found.axis.feature.kind == AxisKind::face_of_a) !=
            (other.axis.feature.kind == AxisKind::face_of_b)) {
      ++ties;
      continue;
    }
    ++compared;
    // Corners that coincide within the clipping thickness have the name from the incident body,
    // which is the other body here.
    if (placement == Placement::offset_copy) continue;
    // The closest points of nearly parallel lines are exact to rounding / sine.
    const double small =
        placement == Placement::parallel_edges ? 1e-8 * c.size() : 1e-10 * c.size();
    bool same = found.points.size() == other.points.size();
    for (const ManifoldPoint& p : found.points) {
      const auto it =
          std::find_if(other.points.begin(), other.points.end(),
                       [&](const ManifoldPoint& q) { return q.key == mirrored_key(p.key); });
      same = same && it != other.points.end() && std::abs(it->gap - p.gap) <= 1e-12 * c.size() &&
             (c.b_in_a * it->position - p.position).norm() <= small;
    }
    if (!same) FAIL_CHECK("case " << i << ": " << name(placement));
  }
  CHECK(compared > 2500);
  CHECK(ties < compared / 2);
}

TEST_CASE("stacked boxes stand on their corners") {
  const CollisionShape box(make_box(Vec3(0.4, 0.3, 0.2)));
  for (double turn : {0.0, 0.3, 1.0}) {
    for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(0.05, 0.02, 0), Vec3(0.1, -0.08, 0)}) {
      const Mat3 rotation = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
      const ShapePair pair(box, box, {rotation, shift + Vec3(0, 0, 0.2 - 1e-5)});
      const Contact found = contact_of(pair, 1e-6, 4);
      REQUIRE(found.points.size() == 4);
      CHECK(found.normal.isApprox(Vec3::UnitZ(), 1e-12));
      // The upper box's centre of mass is above the hull of the points.
      for (const ManifoldPoint& p : found.points) CHECK(p.gap == Approx(-1e-5).epsilon(1e-8));
      CHECK(hull_area(positions(found), Vec3::UnitZ()) > 0.02);
      const std::vector<Vec3> points = around(positions(found), Vec3::UnitZ());
      for (int k = 0; k < 4; ++k) {
        const Vec3 side = points[(k + 1) % 4] - points[k],
                   from = pair.other[0].position - points[k];
        CHECK(side.cross(from).z() > 0.0);
      }
    }
  }
}

TEST_CASE("reduction keeps the deepest point and most of the area") {
  const CollisionShape octagon(prism(8, 0.05, 0.03));
  const std::vector<CollisionShape> shapes{octagon};
  Random random(61);
  for (int i = 0; i < 200; ++i) {
    const Mat3 turn = (Eigen::AngleAxisd(random.uniform(0.0, 6.28), Vec3::UnitZ()) *
                       Eigen::AngleAxisd(1e-5 * random.uniform(), random_direction(random)))
                          .toRotationMatrix();
    const Vec3 shift(random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01), 0.03 - 1e-5);
    const ShapePair pair(shapes[0], shapes[0], {turn, shift});
    const Contact all = contact_of(pair, 1e-4);
    REQUIRE(all.points.size() >= 8);
    double before = 0.0;
    for (int max_points = 1; max_points <= 8; ++max_points) {
      const Contact few = contact_of(pair, 1e-4, max_points);
      REQUIRE(static_cast<int>(few.points.size()) == max_points);
      double least = 1e300;
      for (const ManifoldPoint& p : few.points) least = std::min(least, p.gap);
      CHECK(least == Approx(few.axis.separation).margin(1e-15));
      if (max_points < 3) continue;
      const double share =
          hull_area(positions(few), few.normal) / hull_area(positions(all), few.normal);
      CHECK(share >= before - 1e-9);
      before = share;
      if (max_points == 4) CHECK(share > 0.5);
    }
  }
}

namespace {

constexpr double reach = 1e-4;

/// The best axis of the pair, unless it separates the bodies by more than the reach.
std::optional<SeparatingAxis> best_axis(const ShapePair& pair) {
  static AxisSearch search(collision_pool());
  AxisFeature hint;
  SeparatingAxis axis;
  if (is_separated(search.find(pair, reach, hint, axis))) return std::nullopt;
  return axis;
}

}  // namespace

TEST_CASE("a lone vertex: no other vertex and no edge of its body comes near the face") {
  Random random(93);
  FaceClipper clipper;
  int proved = 0, alone = 0;
  for (int i = 0; i < 20000; ++i) {
    const PairCase c =
        random_case(i % 2 ? Placement::near_touching : Placement::parallel_faces, random);
    const ShapePair pair = c.pair();
    const std::optional<SeparatingAxis> axis = best_axis(pair);
    if (!axis || axis->feature.kind == AxisKind::edges || axis->inside < 0.0) continue;
    const int reference = axis->feature.reference(), face = axis->feature.face();
    // Clips every face of the other body, not only the one that the rule chooses.
    int others = 0;
    const CollisionShape& other = *pair.shape[1 - reference];
    for (int f = 0; f < other.faces().count(); ++f) {
      const auto corners =
          clipper.clip(pair, reference, face_table(*pair.shape[reference], face).view(),
                       face_table(other, f).corners);
      set_heights(corners, pair.shape[reference]->face(face));
      for (const ClippedPoint& p : corners)
        others += p.key != vertex_key(1 - reference, axis->support) && p.height <= reach;
    }
    alone += others == 0;
    if (!is_lone_vertex(pair, *axis, {reach, 4})) continue;
    ++proved;
    if (others > 0) FAIL_CHECK("case " << i << ": " << others << " other points within reach");
  }
  CHECK(proved > 2000);
  CHECK(proved > alone / 2);  // the proof often succeeds
}
