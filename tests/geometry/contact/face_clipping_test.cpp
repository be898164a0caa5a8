#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/contact/contact_manifold.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

/// Corners of the clipped face by definition, each kind by itself: corners of the incident face
/// inside all sides; crossings of its edges with sides; corners of the reference face, projected to
/// the incident plane, inside the incident face. `clear`: no point is close to a boundary, so that
/// all methods must agree.
std::map<std::uint64_t, Vec3> clipped_by_definition(const ShapePair& pair, int reference, int face,
                                                    int incident, bool& clear) {
  const CollisionShape &own = *pair.shape[reference], &other = *pair.shape[1 - reference];
  const RelativePose& pose = pair.other[reference];
  const double doubtful = 1e-7 * pair.size();
  const auto inside_sides = [&](const Vec3& p, int except) {
    double worst = -1.0;
    for (int k = 0; k < own.corner_count(face); ++k)
      if (k != except)
        worst = std::max(worst, own.side(face, k).outward.dot(p) - own.side(face, k).offset);
    clear &= std::abs(worst) > doubtful;
    return worst < 0.0;
  };
  const auto key = [&](PointKind of_own, int own_index, int other_index) {
    if (of_own == PointKind::edges)
      return reference == 0 ? feature_key(of_own, own_index, other_index)
                            : feature_key(of_own, other_index, own_index);
    const bool is_a = (reference == 0) == (own_index >= 0);
    const int index = own_index >= 0 ? own_index : other_index;
    return is_a ? feature_key(PointKind::vertex_of_a, index, 0)
                : feature_key(PointKind::vertex_of_b, 0, index);
  };
  std::map<std::uint64_t, Vec3> points;
  const int count = other.corner_count(incident);
  for (int i = 0; i < count; ++i) {
    const Vec3 p = pose * other.vertices().xyz(other.corner(incident, i).vertex);
    const Vec3 q = pose * other.vertices().xyz(other.corner(incident, (i + 1) % count).vertex);
    if (inside_sides(p, -1))
      points[key(PointKind::vertex_of_b, -1, other.corner(incident, i).vertex)] = p;
    for (int k = 0; k < own.corner_count(face); ++k) {
      const CollisionShape::Side side = own.side(face, k);
      const double at_p = side.outward.dot(p) - side.offset,
                   at_q = side.outward.dot(q) - side.offset;
      if (at_p * at_q >= 0.0) continue;
      const Vec3 crossing = p + at_p / (at_p - at_q) * (q - p);
      if (inside_sides(crossing, k))
        points[key(PointKind::edges, own.corner(face, k).edge, other.corner(incident, i).edge)] =
            crossing;
    }
  }
  const Vec3 up = own.faces().xyz(face), n = pose.rotation * other.faces().xyz(incident);
  const Vec3 on_plane = pose * other.vertices().xyz(other.corner(incident, 0).vertex);
  for (const auto& [v, e, position] : face_table(own, face).corners) {
    const Vec3 corner = position;
    const Vec3 p = corner + up * (n.dot(on_plane - corner) / n.dot(up));
    double worst = -1.0;
    for (const CollisionShape::Side& side : face_table(other, incident).sides)
      worst = std::max(
          worst, side.outward.dot(pose.rotation.transpose() * (p - pose.position)) - side.offset);
    clear &= std::abs(worst) > doubtful;
    if (worst < 0.0) points[key(PointKind::vertex_of_a, v, -1)] = p;
  }
  return points;
}

}  // namespace

TEST_CASE("clipping finds the corners that the definition names, under the same keys") {
  FaceClipper clipper;
  Random random(21);
  int compared = 0, corners = 0, empty = 0;
  for (int i = 0; i < 20000; ++i) {
    const PairCase c =
        random_case(i % 2 ? Placement::parallel_faces : Placement::near_touching, random);
    const ShapePair pair = c.pair();
    const int reference = i / 2 % 2;
    const CollisionShape &own = *pair.shape[reference], &other = *pair.shape[1 - reference];
    // Takes any face of one body and the face of the other that is most opposed to it.
    const int face = random.below(own.faces().count());
    const Vec3 direction = pair.other[reference].rotation.transpose() * own.faces().xyz(face);
    int incident = 0;
    for (int f = 0; f < other.faces().count(); ++f)
      if (other.faces().xyz(f).dot(direction) < other.faces().xyz(incident).dot(direction))
        incident = f;
    if (other.faces().xyz(incident).dot(direction) > -0.05) continue;
    bool clear = true;
    const auto expected = clipped_by_definition(pair, reference, face, incident, clear);
    if (!clear) continue;
    const auto found = clipper.clip(pair, reference, face_table(own, face).view(),
                                    face_table(other, incident).corners);
    ++compared;
    corners += static_cast<int>(found.size());
    empty += found.empty();
    bool same = found.size() == expected.size();
    for (const ClippedPoint& p : found) {
      const auto it = expected.find(p.key);
      same = same && it != expected.end() && (it->second - p.position).norm() <= 1e-9 * c.size();
    }
    if (!same)
      FAIL_CHECK("case " << i << ": " << found.size() << " corners, expected " << expected.size());
  }
  CHECK(compared > 8000);
  CHECK(corners > compared);
  CHECK(empty > compared / 100);
}

TEST_CASE("corners on a side stay corners: equal boxes") {
  const CollisionShape box(make_box(Vec3(1, 1, 1)));
  FaceClipper clipper;
  int top = 0, bottom = 0;
  for (int f = 0; f < 6; ++f) {
    if (box.faces().xyz(f).z() > 0.5) top = f;
    if (box.faces().xyz(f).z() < -0.5) bottom = f;
  }
  Random random(5);
  for (double noise : {0.0, 1e-15, 1e-10}) {
    const Vec3 shift(noise * random.uniform(-1, 1), noise * random.uniform(-1, 1), 1.0);
    const auto points = clipper.clip(ShapePair(box, box, {Mat3::Identity(), shift}), 0,
                                     face_table(box, top).view(), face_table(box, bottom).corners);
    REQUIRE(points.size() == 4);
    for (const ClippedPoint& p : points) CHECK(p.key < 8);  // vertices of b
  }
}

TEST_CASE("keys of different places differ") {
  std::vector<std::uint64_t> keys;
  for (PointKind kind :
       {PointKind::vertex_of_a, PointKind::vertex_of_b, PointKind::edges, PointKind::sides}) {
    for (int a : {0, 1, 2, 70000, 0x7fffffff}) {
      for (int b : {0, 1, 2, 70000, 0x7fffffff}) keys.push_back(feature_key(kind, a, b));
    }
  }
  std::sort(keys.begin(), keys.end());
  CHECK(std::adjacent_find(keys.begin(), keys.end()) == keys.end());
  CHECK(feature_key(PointKind::vertex_of_b, 0, 5) == 5);
}
