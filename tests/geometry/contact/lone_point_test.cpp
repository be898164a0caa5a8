// The proofs of a lone point against clipping, which looks at all corners.

#include "geometry/contact/lone_point.hpp"

#include "geometry/contact/axis_search.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/contact/detection_support.hpp"

using namespace ballast;
using namespace ballast::testing;

namespace {

constexpr double reach = 1e-4;

/// The pair's best axis, if it does not separate the bodies by more than the reach distance.
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
    // every face of the other body is cut, not only the one that the rule chooses
    int others = 0;
    const CollisionShape& other = *pair.shape[1 - reference];
    for (int f = 0; f < other.faces().count(); ++f) {
      const auto corners =
          clipper.clip(pair, reference, face_table(*pair.shape[reference], face).view(),
                       face_table(other, f).view(), clipping_thickness(c.size()));
      set_heights(corners, pair.shape[reference]->face(face));
      for (const ClippedPoint& p : corners)
        others += p.key != vertex_key(1 - reference, axis->support) && p.height <= reach;
    }
    alone += others == 0;
    if (!is_lone_vertex(pair, *axis, reach)) continue;
    ++proved;
    if (others > 0) FAIL_CHECK("case " << i << ": " << others << " other points within reach");
  }
  CHECK(proved > 2000);
  CHECK(proved > alone / 2);  // the proof is worth having
}

TEST_CASE("two flat edges whose faces rise out of reach: clipping finds their crossing alone") {
  Random random(92);
  FaceClipper clipper;
  int proved = 0, alone = 0;
  for (int i = 0; i < 60000; ++i) {
    const PairCase c = i % 3 ? edges_together(std::abs(random_scale(random, 1.5, 0.0)), random)
                             : random_case(Placement::near_touching, random);
    const ShapePair pair = c.pair();
    const std::optional<SeparatingAxis> axis = best_axis(pair);
    if (!axis || axis->feature.kind != AxisKind::edges) continue;
    const AxisFeature feature = axis->feature;
    const CollisionShape::Edge a = pair.shape[0]->edge(feature.a),
                               b = pair.shape[1]->edge(feature.b);
    const EdgesMeeting meeting(pair, *axis, a, b);
    if (meeting.is_sharp()) continue;
    const int reference = meeting.reference();
    const int face = reference == 0 ? meeting.face_a : meeting.face_b;
    const Vec3 direction =
        reference == 0 ? axis->direction : Vec3(-(pair.other[1].rotation * axis->direction));
    const CollisionShape::FaceTable beside_a = face_table(*pair.shape[0], meeting.face_a),
                                    beside_b = face_table(*pair.shape[1], meeting.face_b);
    const auto corners =
        clipper.clip_along(pair, reference, reference == 0 ? beside_a.view() : beside_b.view(),
                           reference == 0 ? beside_b.view() : beside_a.view(), direction,
                           clipping_thickness(c.size()));
    set_heights(corners, pair.shape[reference]->face(face), direction);
    const auto crossing = feature_key(PointKind::edges, feature.a, feature.b);
    int others = 0;
    for (const ClippedPoint& p : corners) others += p.key != crossing && p.height <= reach;
    alone += others == 0;
    if (!is_lone_crossing(pair, *axis, meeting, edge_of_face(a, feature.a, beside_a.view()),
                          edge_of_face(b, feature.b, beside_b.view()), reach))
      continue;
    ++proved;
    if (others > 0) FAIL_CHECK("case " << i << ": " << others << " other corners within reach");
  }
  CHECK(alone > 1000);
  CHECK(proved > alone / 2);  // the proof is worth having
}
