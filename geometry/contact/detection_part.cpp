#include "geometry/contact/detection_part.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

namespace ballast {

DetectedBodies::DetectedBodies(std::vector<ContactShape> bodies, const ConvexElements* elements)
    : shapes(std::move(bodies)), rotations(shapes.size()), travel(shapes.size()) {
  // Bodies with the same polyhedron share its tables.
  std::map<const Polyhedron*, size_t> number;
  std::vector<const Polyhedron*> distinct;
  for (const ContactShape& body : shapes)
    if (body.polyhedron && number.emplace(body.polyhedron, distinct.size()).second)
      distinct.push_back(body.polyhedron);
  tables.reserve(distinct.size());
  for (const Polyhedron* polyhedron : distinct) tables.emplace_back(*polyhedron);
  for (int i = 0; i < count(); ++i) {
    const ContactShape& body = shapes[i];
    const CollisionShape* table = body.polyhedron ? &tables[number[body.polyhedron]] : nullptr;
    is_fixed.push_back(body.fixed);
    bounds.push_back(table ? table->bounds() : BodyBounds{});
    listed.push_back(
        {table, body.fixed, elements ? elements->body(i) : -1, elements && elements->is_image(i)});
  }
}

void DetectedBodies::take(std::span<const Pose> new_poses, std::span<const double> new_reach,
                          std::span<const Pose> new_ahead, WorkerTeam* team) {
  poses = new_poses;
  reach = new_reach;
  ahead = new_ahead;
  if (previous_.empty()) previous_.assign(poses.begin(), poses.end());
  run_each(team, count(), /*together=*/64, [&](int i) {
    rotations[i] = poses[i].rotation.toRotationMatrix();
    // The motion is summed up step by step: the difference of the sums at two times bounds the
    // motion between them.
    const MotionBound step = step_bound(previous_[i], poses[i]);
    travel[i].shift += step.shift;
    travel[i].turn += step.turn;
    previous_[i] = poses[i];
  });
}

DetectionPart::DetectionPart(const DetectedBodies& bodies, const DetectionSettings& settings)
    : bodies_(bodies), settings_(settings), search_(bodies.tables) {
  size_t vertices = 0;
  for (const CollisionShape& shape : bodies.tables)
    vertices = std::max(vertices, static_cast<size_t>(shape.vertices().padded()));
  heights_.resize(vertices);
}

void DetectionPart::detect(BroadPhase& broad_phase, std::vector<ContactPoint>& contacts) {
  counters_ = DetectionCounters{};
  choose_pairs(broad_phase);
  size_t next = 0;
  for (int a = begin_; a < end_; ++a) {
    if (!bodies_.shape(a)) detect_plane(a, contacts);
    for (; next < chosen_.size() && chosen_[next] < broad_phase.first(a + 1); ++next) {
      prefetch(broad_phase, next + 4);
      detect_pair(broad_phase, broad_phase.pairs()[chosen_[next]], contacts);
    }
  }
}

/// How far the bodies of a pair can have come closer since the first call, by their travel [m].
double DetectionPart::bound_use(const CandidatePair& pair) const {
  const MotionBound &a = bodies_.travel[pair.a], &b = bodies_.travel[pair.b];
  return (a.shift + b.shift) + (pair.arm_a * a.turn + pair.arm_b * b.turn);
}

/// Chooses all candidates except those that are proved apart by the bodies' travel alone.
void DetectionPart::choose_pairs(const BroadPhase& broad_phase) {
  chosen_.clear();
  const std::span<const CandidatePair> pairs = broad_phase.pairs();
  const std::span<const double> reach = bodies_.reach;
  const int end = broad_phase.first(end_);
  counters_.candidate_pairs = end - broad_phase.first(begin_);
  for (int k = broad_phase.first(begin_); k < end; ++k) {
    const CandidatePair& pair = pairs[k];
    if (settings_.use_cache && bound_use(pair) + (reach[pair.a] + reach[pair.b]) < pair.apart_below)
      counters_.cached_separations += pair.arm_a > 0.0;  // by an axis, not by the spheres alone
    else
      chosen_.push_back(k);
  }
}

/// Records that the pair is `separation` [m] apart. This shrinks by no more than the shifts of the
/// origins plus the arms times the turns.
void DetectionPart::bound_separation(CandidatePair& pair, double arm_a, double arm_b,
                                     double separation) const {
  pair.arm_a = arm_a;
  pair.arm_b = arm_b;
  const double use = bound_use(pair);
  // 1e-9 is far above the rounding of separations and of sums over 1e7 steps
  pair.apart_below =
      separation + use -
      1e-9 * (bodies_.bounds[pair.a].circumradius + bodies_.bounds[pair.b].circumradius + use);
}

/// The same for a pair that an axis of this kind separates, with the origins `distance` [m] apart.
/// A face's separation is the least n.(x - p) over the other body's points x, less the face's
/// offset, with p the origin of the face's body. It shrinks by no more than x and p move plus that
/// body's turn times |x - p|. A separating face is found whatever the hint, so that a bound does
/// not change the outcome. Two edges may cease to be a facet, so they give no bound.
void DetectionPart::bound_separated(CandidatePair& pair, double distance, AxisKind kind,
                                    double separation) const {
  const double radius_a = bodies_.bounds[pair.a].circumradius,
               radius_b = bodies_.bounds[pair.b].circumradius;
  if (kind == AxisKind::face_of_a)
    bound_separation(pair, distance + radius_b, radius_b, separation);
  if (kind == AxisKind::face_of_b)
    bound_separation(pair, radius_a, distance + radius_a, separation);
}

/// Appends the contacts of all bodies with a plane: every vertex within reach is a point.
void DetectionPart::detect_plane(int plane, std::vector<ContactPoint>& contacts) {
  const std::span<const Pose> poses = bodies_.poses;
  const std::span<const double> reach = bodies_.reach;
  const Vec3 normal = contact_normal(bodies_.rotations[plane], bodies_.shapes[plane].plane);
  const Vec3& origin = poses[plane].position;
  const auto height_of = [&](int b) { return normal.dot(poses[b].position - origin); };
  near_.clear();
  for (int b = 0; b < bodies_.count(); ++b)
    if (!(height_of(b) > bodies_.bounds[b].circumradius + (reach[plane] + reach[b])) &&
        bodies_.shape(b) && !(bodies_.is_fixed[plane] && bodies_.is_fixed[b]) &&
        !bodies_.listed[b].image)
      near_.push_back(b);
  constexpr size_t ahead = 6;  // bodies
  for (size_t k = 0; k < near_.size(); ++k) {
    if (k + ahead < near_.size()) bodies_.shape(near_[k + ahead])->vertices().prefetch();
    const int b = near_[k];
    const double alert = reach[plane] + reach[b], height = height_of(b);
    const AffineRows& vertices = bodies_.shape(b)->vertices();
    vertices.evaluate(bodies_.rotations[b].transpose() * normal, heights_.data());
    const size_t before = contacts.size();
    for (int v = 0; v < vertices.count(); ++v) {
      const double gap = height + heights_[v];
      if (gap > alert) continue;
      const Vec3 vertex = poses[b].position + bodies_.rotations[b] * vertices.xyz(v);
      contacts.push_back(
          {plane, b, vertex_key(1, v), normal, midway_from_b(vertex, gap, normal), gap});
    }
    if (contacts.size() > before) ++counters_.manifolds;
  }
}

void DetectionPart::detect_pair(BroadPhase& broad_phase, CandidatePair& candidate,
                                std::vector<ContactPoint>& contacts) {
  const std::span<const Pose> poses = bodies_.poses;
  const std::span<const double> reach = bodies_.reach;
  const int a = candidate.a, b = candidate.b;
  const double alert = reach[a] + reach[b];
  const Vec3 between = poses[b].position - poses[a].position;
  const double radii = bodies_.bounds[a].circumradius + bodies_.bounds[b].circumradius;
  if (between.squaredNorm() > (radii + alert) * (radii + alert)) {
    bound_separation(candidate, 0.0, 0.0, between.norm() - radii);  // separation of the spheres
    return;
  }

  // Written as products with transposes: a transposed copy would add in another order, and
  // published runs have these bits.
  const Mat3& rotation = bodies_.rotations[a];
  const RelativePose b_in_a{rotation.transpose() * bodies_.rotations[b],
                            rotation.transpose() * between};
  candidate.apart_below = -1.0;
  ManifoldLimits limits{alert, settings_.max_points,
                        bodies_.is_fixed[a] || bodies_.is_fixed[b] ? settings_.joint : -1.0};
  const double turn = bodies_.travel[a].turn + bodies_.travel[b].turn;
  if (settings_.use_cache && candidate.touching >= 0) {
    const PairFrame pair(bodies_.bounds[a], bodies_.bounds[b], b_in_a);
    TouchingPair::Answer known =
        broad_phase.memory(candidate.touching).look(pair, turn, limits, manifold_);
    switch (known.outcome) {
      case TouchingPair::PairOutcome::touching:
        ++counters_.proved_axes;
        if (passes(candidate, limits, known.axis, contacts)) return;
        return append(candidate, pair, known.axis, known.points, contacts);
      case TouchingPair::PairOutcome::apart:
        ++counters_.cached_separations;
        return bound_separated(candidate, between.norm(), known.axis.feature.kind,
                               known.axis.separation);
      case TouchingPair::PairOutcome::undecided:
        break;
    }
  }

  const ShapePair pair(*bodies_.shape(a), *bodies_.shape(b), b_in_a);
  if (!settings_.use_cache) candidate.axis = {};
  SeparatingAxis axis;
  const AxisOutcome outcome = search_.find(pair, alert, candidate.axis, axis);
  if (outcome == AxisOutcome::separated_by_hint) ++counters_.cached_separations;
  if (outcome == AxisOutcome::proved_by_hint) ++counters_.proved_axes;
  if (outcome == AxisOutcome::separated || outcome == AxisOutcome::found) ++counters_.full_tests;
  if (is_separated(outcome))
    return bound_separated(candidate, between.norm(), candidate.axis.kind, axis.separation);
  // Bodies apart whose nearest points lie off the axis may be farther apart than the axis says.
  // Whether they count must not depend on the margin with which the broad phase listed them: they
  // count if it would list them without any margin.
  if (axis.separation > 0.0 && axis.inside < 0.0 && !boxes_within_reach(candidate, alert)) return;
  if (settings_.use_cache) {
    if (candidate.touching < 0) candidate.touching = broad_phase.new_place();
    broad_phase.memory(candidate.touching).record(pair, axis, turn, heights_);
  }
  if (passes(candidate, limits, axis, contacts)) return;
  append(candidate, pair, axis, manifold_.points(pair, axis, limits), contacts);
}

/// Lets a pair pass where its motion until the next detection leads past a fixed body's side:
/// another facet then separates the bodies best. If that facet does so at present too, it replaces
/// the pair's axis and gives points only where one body lies over the other. If it does not yet, it
/// must do so in time, or the way leads through the fixed body. False: the pair's own axis stands.
bool DetectionPart::passes(const CandidatePair& candidate, ManifoldLimits& limits,
                           SeparatingAxis& axis, std::vector<ContactPoint>& contacts) {
  if (limits.joint < 0.0 || bodies_.ahead.empty() || axis.separation < -limits.joint) return false;
  const int a = candidate.a, b = candidate.b;
  const auto pair_at = [&](std::span<const Pose> poses) {
    const Mat3 from_world = poses[a].rotation.toRotationMatrix().transpose();
    return ShapePair(*bodies_.shape(a), *bodies_.shape(b),
                     {from_world * poses[b].rotation.toRotationMatrix(),
                      from_world * (poses[b].position - poses[a].position)});
  };
  const ShapePair then = pair_at(bodies_.ahead);
  const auto closing = evaluate_axis(then, axis.feature, heights_);
  if (closing && closing->separation >= -limits.joint) return false;
  AxisFeature feature = axis.feature;
  SeparatingAxis last;
  search_.find(then, std::numeric_limits<double>::infinity(), feature, last);
  if (feature == axis.feature) return false;
  const ShapePair now = pair_at(bodies_.poses);
  const auto instead = evaluate_axis(now, feature, heights_);
  const double separation =
      instead ? instead->separation
              : separation_along(bodies_.ahead[a].rotation * contact_normal(then, last), a, b);
  if (separation < -limits.joint)  // in time means before the pair's own facet closes
    return closing && last.separation >= -limits.joint &&
           -(separation + limits.joint) * (axis.separation - closing->separation) <=
               (axis.separation + limits.joint) * (last.separation - separation);
  if (!instead) return last.separation >= -limits.joint;  // not a facet yet
  axis = *instead;
  limits.is_passing = true;
  append(candidate, now, axis, manifold_.points(now, axis, limits), contacts);
  return true;
}

/// The present separation of a and b along a unit vector from a to b in the world frame [m].
double DetectionPart::separation_along(const Vec3& normal_W, int a, int b) {
  const auto least = [&](int body, const Vec3& direction) {
    const auto& vertices = bodies_.shape(body)->vertices();
    vertices.evaluate(bodies_.rotations[body].transpose() * direction, heights_.data());
    return *std::min_element(heights_.begin(), heights_.begin() + vertices.count());
  };
  const Vec3 between = bodies_.poses[b].position - bodies_.poses[a].position;
  return least(a, -normal_W) + normal_W.dot(between) + least(b, normal_W);
}

void DetectionPart::append(const CandidatePair& candidate, const PairFrame& frame,
                           const SeparatingAxis& axis, std::span<const ManifoldPoint> points,
                           std::vector<ContactPoint>& contacts) {
  const int a = candidate.a, b = candidate.b;
  const double alert = bodies_.reach[a] + bodies_.reach[b];
  const size_t before = contacts.size();
  const Mat3& rotation = bodies_.rotations[a];
  const Vec3 normal_W = rotation * contact_normal(frame, axis), origin = bodies_.poses[a].position;
  for (const ManifoldPoint& point : points)
    if (point.gap <= alert)
      contacts.push_back(
          {a, b, point.key, normal_W, origin + rotation * point.position, point.gap});
  if (contacts.size() > before) ++counters_.manifolds;
}

/// Prefetches the record of a pair that is tested a few pairs later: the list of pairs is read in
/// order, its records nearly so.
void DetectionPart::prefetch(BroadPhase& broad_phase, size_t next) const {
  if (next >= chosen_.size()) return;
  const int place = broad_phase.pairs()[chosen_[next]].touching;
  if (place < 0) return;
  const char* lines = reinterpret_cast<const char*>(&broad_phase.memory(place));
  for (size_t line = 0; line < sizeof(TouchingPair); line += 64) __builtin_prefetch(lines + line);
}

bool DetectionPart::boxes_within_reach(const CandidatePair& pair, double alert) const {
  const Bounds box_a = bounding_box(*bodies_.shape(pair.a), bodies_.rotations[pair.a],
                                    bodies_.poses[pair.a].position);
  const Bounds box_b = bounding_box(*bodies_.shape(pair.b), bodies_.rotations[pair.b],
                                    bodies_.poses[pair.b].position);
  return (box_b.low - box_a.high).maxCoeff() <= alert &&
         (box_a.low - box_b.high).maxCoeff() <= alert;
}

}  // namespace ballast
