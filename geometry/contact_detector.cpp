#include "geometry/contact_detector.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "geometry/axis_search.hpp"
#include "geometry/broad_phase.hpp"
#include "geometry/shape_tables.hpp"
#include "geometry/touching_pair.hpp"

namespace ballast {
namespace {

double chosen_skin(double skin, std::span<const CollisionShape> shapes) {
  if (skin > 0.0 || shapes.empty()) return skin;
  double sum = 0.0;
  for (const CollisionShape& shape : shapes) sum += shape.circumradius();
  return 0.05 * sum / static_cast<double>(shapes.size());
}

}  // namespace

struct ContactDetector::State {
  State(std::vector<ContactShape> bodies, const DetectionSettings& detection)
      : shapes(std::move(bodies)),
        settings(detection),
        tables(shapes),
        broad_phase(broad_phase_bodies(), chosen_skin(settings.skin, tables.tables)),
        search(tables.tables),
        rotations(shapes.size()),
        travel(shapes.size()) {
    for (size_t i = 0; i < shapes.size(); ++i) {
      const CollisionShape* table = shape(static_cast<int>(i));
      bounds.push_back(table ? table->bounds() : BodyBounds{});
    }
    size_t vertices = 0;
    for (const CollisionShape& shape : tables.tables)
      vertices = std::max(vertices, static_cast<size_t>(shape.vertices().padded()));
    heights.resize(vertices);
  }

  std::vector<BroadPhase::Body> broad_phase_bodies() const {
    std::vector<BroadPhase::Body> bodies;
    for (size_t i = 0; i < shapes.size(); ++i) bodies.push_back({shape(static_cast<int>(i)), shapes[i].fixed});
    return bodies;
  }
  const CollisionShape* shape(int body) const {
    return tables.index[body] < 0 ? nullptr : &tables.tables[tables.index[body]];
  }

  void check(std::span<const Pose> poses, std::span<const double> reach) const;
  void detect_plane(int plane, std::span<const Pose> poses, std::span<const double> reach,
                    std::vector<ContactPoint>& contacts);
  void detect_pair(CandidatePair& pair, std::span<const Pose> poses, std::span<const double> reach,
                   std::vector<ContactPoint>& contacts);
  void remember(CandidatePair& candidate, const ShapePair& pair, const SeparatingAxis& axis, double turn);
  void sort_touching();
  void fetch(size_t next) const;
  void advance(std::span<const Pose> poses);
  void choose_pairs(std::span<const double> reach);
  void bound_separation(CandidatePair& pair, double arm_a, double arm_b, double separation) const;
  void bound_separated(CandidatePair& pair, double distance, double separation) const;
  double bound_use(const CandidatePair& pair) const;
  bool boxes_within_reach(const CandidatePair& pair, std::span<const Pose> poses, double alert) const;

  std::vector<ContactShape> shapes;
  DetectionSettings settings;
  ShapeTables tables;
  BroadPhase broad_phase;
  AxisSearch search;
  ContactManifold manifold;
  std::vector<Mat3> rotations;     // R_WB at the poses of this call
  std::vector<BodyBounds> bounds;  // of all bodies, in one place; zero for planes
  std::vector<Pose> previous;      // poses of the last call
  std::vector<Travel> travel;      // since the first call
  std::vector<TouchingPair> touching, old_touching;
  std::vector<int> chosen;  // candidate pairs that must be looked at
  Heights heights;
  DetectionCounters counters;
};

ContactDetector::ContactDetector(std::vector<ContactShape> shapes, const DetectionSettings& settings)
    : state_(std::make_unique<State>(std::move(shapes), settings)) {}
ContactDetector::~ContactDetector() = default;
ContactDetector::ContactDetector(ContactDetector&&) noexcept = default;
ContactDetector& ContactDetector::operator=(ContactDetector&&) noexcept = default;
const DetectionCounters& ContactDetector::counters() const { return state_->counters; }

void ContactDetector::detect(std::span<const Pose> poses, std::span<const double> reach,
                             std::vector<ContactPoint>& contacts) {
  State& s = *state_;
  s.check(poses, reach);
  contacts.clear();
  for (size_t i = 0; i < poses.size(); ++i) s.rotations[i] = poses[i].rotation.toRotationMatrix();
  const long rebuilds = s.broad_phase.rebuilds();
  s.broad_phase.update(poses, s.rotations, reach);
  if (s.broad_phase.rebuilds() != rebuilds) s.sort_touching();
  s.counters = DetectionCounters{};
  s.counters.candidate_pairs = static_cast<long>(s.broad_phase.pairs().size());
  s.counters.broad_phase_rebuilds = s.broad_phase.rebuilds();
  s.advance(poses);
  s.choose_pairs(reach);
  size_t next = 0;
  for (int a = 0; a < static_cast<int>(s.shapes.size()); ++a) {
    if (!s.shape(a)) s.detect_plane(a, poses, reach, contacts);
    for (; next < s.chosen.size() && s.chosen[next] < s.broad_phase.first(a + 1); ++next) {
      s.fetch(next + 4);
      s.detect_pair(s.broad_phase.pairs()[s.chosen[next]], poses, reach, contacts);
    }
  }
}

void ContactDetector::State::advance(std::span<const Pose> poses) {
  for (size_t i = 0; i < previous.size(); ++i) {
    const Travel step = step_bound(previous[i], poses[i]);
    travel[i].shift += step.shift;
    travel[i].turn += step.turn;
  }
  previous.assign(poses.begin(), poses.end());
}

/// What the bodies of a pair have used up of its bound, less their reaches.
double ContactDetector::State::bound_use(const CandidatePair& pair) const {
  const Travel &a = travel[pair.a], &b = travel[pair.b];
  return (a.shift + b.shift) + (pair.arm_a * a.turn + pair.arm_b * b.turn);
}

/// All candidates but those whose separation is proved without a look at their shapes.
void ContactDetector::State::choose_pairs(std::span<const double> reach) {
  chosen.clear();
  const std::span<const CandidatePair> pairs = broad_phase.pairs();
  for (size_t k = 0; k < pairs.size(); ++k) {
    const CandidatePair& pair = pairs[k];
    if (settings.use_cache && bound_use(pair) + (reach[pair.a] + reach[pair.b]) < pair.apart_below)
      counters.cached_separations += pair.arm_a > 0.0;  // by an axis, not by the spheres alone
    else
      chosen.push_back(static_cast<int>(k));
  }
}

/// `separation` shrinks by no more than the origins move and the arms times the turns.
void ContactDetector::State::bound_separation(CandidatePair& pair, double arm_a, double arm_b,
                                              double separation) const {
  pair.arm_a = arm_a;
  pair.arm_b = arm_b;
  const double use = bound_use(pair);
  // far above the rounding of separations and of sums over 1e7 steps
  pair.apart_below = separation + use - 1e-9 * (bounds[pair.a].circumradius + bounds[pair.b].circumradius + use);
}

/// Of a pair whose axis separates it, at this `distance` of the origins. A face's separation is the least n.(x - p) of
/// the other body's points x, less the face's offset: it shrinks by no more than x and the face's body p move, and by
/// that body's turn times |x - p|. A separating face is found whatever the hint, hence the outcome is the one without a
/// bound. An edge pair may cease to be a facet: no bound.
void ContactDetector::State::bound_separated(CandidatePair& pair, double distance, double separation) const {
  const double radius_a = bounds[pair.a].circumradius, radius_b = bounds[pair.b].circumradius;
  if (pair.axis.kind == AxisKind::face_of_a) bound_separation(pair, distance + radius_b, radius_b, separation);
  if (pair.axis.kind == AxisKind::face_of_b) bound_separation(pair, radius_a, distance + radius_a, separation);
}

void ContactDetector::State::check(std::span<const Pose> poses, std::span<const double> reach) const {
  if (poses.size() != shapes.size() || reach.size() != shapes.size())
    throw std::invalid_argument("detect: " + std::to_string(shapes.size()) + " bodies, but " +
                                std::to_string(poses.size()) + " poses and " + std::to_string(reach.size()) +
                                " reaches");
  for (size_t i = 0; i < poses.size(); ++i) {
    if (!poses[i].position.allFinite() || !poses[i].rotation.coeffs().allFinite() || !(reach[i] >= 0.0))
      throw std::invalid_argument("detect: pose or reach of body " + std::to_string(i) + " is not a finite number");
  }
}

/// Every vertex within reach is a point.
void ContactDetector::State::detect_plane(int plane, std::span<const Pose> poses, std::span<const double> reach,
                                          std::vector<ContactPoint>& contacts) {
  const Vec3 normal = rotations[plane] * shapes[plane].plane.normal;
  const Vec3& origin = poses[plane].position;
  for (int b = 0; b < static_cast<int>(shapes.size()); ++b) {
    const CollisionShape* body = shape(b);
    if (!body || (shapes[plane].fixed && shapes[b].fixed)) continue;
    const double alert = reach[plane] + reach[b];
    const double height = normal.dot(poses[b].position - origin);
    if (height > bounds[b].circumradius + alert) continue;
    body->vertices().evaluate(rotations[b].transpose() * normal, heights.data());
    const size_t before = contacts.size();
    for (int v = 0; v < body->vertices().count(); ++v) {
      const double gap = height + heights[v];
      if (gap > alert) continue;
      const Vec3 vertex = poses[b].position + rotations[b] * body->vertices().xyz(v);
      contacts.push_back(
          {plane, b, feature_key(PointKind::vertex_of_b, 0, v), normal, vertex - 0.5 * gap * normal, gap});
    }
    if (contacts.size() > before) ++counters.manifolds;
  }
}

void ContactDetector::State::detect_pair(CandidatePair& candidate, std::span<const Pose> poses,
                                         std::span<const double> reach, std::vector<ContactPoint>& contacts) {
  const int a = candidate.a, b = candidate.b;
  const double alert = reach[a] + reach[b];
  const Vec3 between = poses[b].position - poses[a].position;
  const double radii = bounds[a].circumradius + bounds[b].circumradius;
  if (between.squaredNorm() > (radii + alert) * (radii + alert)) {
    bound_separation(candidate, 0.0, 0.0, between.norm() - radii);  // of the spheres
    return;
  }

  const Mat3& rotation = rotations[a];
  const RelativePose b_in_a{rotation.transpose() * rotations[b], rotation.transpose() * between};
  const auto add = [&](const SeparatingAxis& axis, std::span<const ManifoldPoint> points) {
    ++counters.manifolds;
    const Vec3 normal = rotation * axis.normal;
    for (const ManifoldPoint& point : points)
      contacts.push_back({a, b, point.key, normal, poses[a].position + rotation * point.position, point.gap});
  };
  candidate.apart_below = -1.0;
  SeparatingAxis axis;
  const double turn = travel[a].turn + travel[b].turn;
  if (settings.use_cache && candidate.touching >= 0) {
    ManifoldPoint point;
    switch (touching[candidate.touching].look(PairFrame(bounds[a], bounds[b], b_in_a), turn, alert, axis, point)) {
      case TouchingPair::Look::touching:
        ++counters.proved_axes;
        return add(axis, {&point, 1});
      case TouchingPair::Look::apart:
        ++counters.cached_separations;
        return bound_separated(candidate, between.norm(), axis.separation);
      case TouchingPair::Look::undecided:
        break;
    }
  }

  const ShapePair pair(*shape(a), *shape(b), b_in_a);
  if (!settings.use_cache) candidate.axis = {};
  const AxisOutcome outcome = search.find(pair, alert, candidate.axis, axis);
  if (outcome == AxisOutcome::separated_by_hint) ++counters.cached_separations;
  if (outcome == AxisOutcome::proved_by_hint) ++counters.proved_axes;
  if (outcome == AxisOutcome::separated || outcome == AxisOutcome::found) ++counters.full_tests;
  if (is_separated(outcome)) return bound_separated(candidate, between.norm(), axis.separation);
  // Bodies apart whose nearest points lie off the axis may be farther apart than the axis says. Which of them count
  // must not depend on which the broad phase happened to list: those that it lists with no margin at all.
  if (axis.separation > 0.0 && axis.inside < 0.0 && !boxes_within_reach(candidate, poses, alert)) return;
  add(axis, manifold.points(pair, axis, alert, settings.max_points));
  if (settings.use_cache) remember(candidate, pair, axis, turn);
}

void ContactDetector::State::remember(CandidatePair& candidate, const ShapePair& pair, const SeparatingAxis& axis,
                                      double turn) {
  if (candidate.touching < 0) {
    candidate.touching = static_cast<int>(touching.size());
    touching.emplace_back();
  }
  touching[candidate.touching].record(pair, axis, turn);
}

/// Brings the records into the order of the new list and drops those of pairs that left it.
void ContactDetector::State::sort_touching() {
  old_touching.swap(touching);
  touching.clear();
  touching.reserve(broad_phase.pairs().size());
  for (CandidatePair& pair : broad_phase.pairs()) {
    if (pair.touching < 0) continue;
    touching.push_back(old_touching[pair.touching]);
    pair.touching = static_cast<int>(touching.size()) - 1;
  }
}

/// The record is needed four pairs from now; the list of pairs is read in order, its records nearly so.
void ContactDetector::State::fetch(size_t next) const {
  if (next >= chosen.size()) return;
  const int record = broad_phase.pairs()[chosen[next]].touching;
  if (record < 0) return;
  const char* lines = reinterpret_cast<const char*>(&touching[record]);
  for (size_t line = 0; line < sizeof(TouchingPair); line += 64) __builtin_prefetch(lines + line);
}

bool ContactDetector::State::boxes_within_reach(const CandidatePair& pair, std::span<const Pose> poses,
                                                double alert) const {
  const Box box_a = bounding_box(*shape(pair.a), rotations[pair.a], poses[pair.a].position);
  const Box box_b = bounding_box(*shape(pair.b), rotations[pair.b], poses[pair.b].position);
  return (box_b.low - box_a.high).maxCoeff() <= alert && (box_a.low - box_b.high).maxCoeff() <= alert;
}

}  // namespace ballast
