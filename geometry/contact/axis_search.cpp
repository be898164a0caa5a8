#include "geometry/contact/axis_search.hpp"

#include <algorithm>
#include <limits>

namespace ballast {
namespace {

constexpr double minus_infinity = -std::numeric_limits<double>::infinity();

/// Index of the largest value, the smallest among equals.
int argmax(const double* values, int padded) {
  // Takes the maximum of each lane, then that of all lanes, and looks for its row last.
  using Lanes = Eigen::Array<double, 8, 1>;
  Lanes most = Eigen::Map<const Lanes>(values);
  for (int i = 8; i < padded; i += 8) most = most.max(Eigen::Map<const Lanes>(values + i));
  const double largest = most.maxCoeff();
  int row = 0;
  while (values[row] != largest) ++row;
  return row;
}

}  // namespace

AxisSearch::AxisSearch(std::span<const CollisionShape> shapes) {
  int faces = 8, vertices = 8;
  size_t edges = 0;
  for (const CollisionShape& shape : shapes) {
    faces = std::max(faces, shape.faces().padded());
    vertices = std::max(vertices, shape.vertices().padded());
    edges = std::max(edges, static_cast<size_t>(shape.edge_count()));
  }
  heights_.resize(vertices);
  for (Side& side : side_) {
    side.bound.resize(faces);
    side.value.resize(faces);
    side.heights.resize(static_cast<size_t>(faces) * most_witnesses);
    side.edges.reserve(edges);
  }
  turned_.reserve(edges);
}

AxisOutcome AxisSearch::find(const ShapePair& pair, double alert, AxisFeature& hint,
                             SeparatingAxis& axis) {
  const std::optional<SeparatingAxis> last = evaluate_axis(pair, hint, heights_);
  if (!last) return search(pair, alert, nullptr, hint, axis);
  axis.separation = last->separation;
  // A gap above `alert` along any direction means no contact, whichever axis is the best.
  if (last->separation > alert) return AxisOutcome::separated_by_hint;
  if (!is_proved_best(pair, face_isolation(pair, hint), *last))
    return search(pair, alert, &*last, hint, axis);
  axis = *last;
  return AxisOutcome::proved_by_hint;
}

AxisOutcome AxisSearch::search(const ShapePair& pair, double alert, const SeparatingAxis* start,
                               AxisFeature& hint, SeparatingAxis& axis) {
  // Branch and bound over all facets of the Minkowski difference: the faces of both bodies, then
  // those pairs of edges that no witness rules out.
  best_ = start ? start->separation : minus_infinity;
  best_feature_ = start ? start->feature : AxisFeature{};
  edge_pairs_.clear();
  for (int own : {0, 1}) start_side(pair, own);
  if (start) add_witnesses_of(pair, *start);
  bool apart = search_faces(pair, 0, alert) || search_faces(pair, 1, alert);
  if (!apart) {
    // An edge pair with a larger separation lies near the best axis so far, so the corners of that
    // axis' facet are the tightest witnesses.
    if (!start || !(best_feature_ == start->feature))
      add_witnesses_of(pair, *evaluate_axis(pair, best_feature_, heights_));
    apart = search_edges(pair, alert);
  }
  hint = apart ? best_feature_ : choose(pair);
  axis.separation = best_;
  if (apart) return AxisOutcome::separated;
  axis = *evaluate_axis(pair, hint, heights_);
  return AxisOutcome::found;
}

/// Resets the side of body `own` and bounds its faces' separations by the ball in the other body.
void AxisSearch::start_side(const ShapePair& pair, int own) {
  const CollisionShape& other = *pair.shape[1 - own];
  const AffineRows& faces = pair.shape[own]->faces();
  Side& side = side_[own];
  side.witnesses = 0;
  side.edges.clear();
  // The other body contains a ball with centre c and radius r, so that min n.x over it is at most
  // n.c - r: the height of c over a face, less r, bounds the face's separation from above.
  faces.evaluate(pair.other[own] * other.bounds().ball_centre, side.bound.data());
  for (int f = 0; f < faces.padded(); ++f) side.bound[f] -= other.bounds().ball_radius;
  std::fill_n(side.value.begin(), faces.padded(), minus_infinity);
}

/// `point`: a point of the other body, in the frame of body `own`.
void AxisSearch::add_witness(const ShapePair& pair, int own, const Vec3& point) {
  const AffineRows& faces = pair.shape[own]->faces();
  Side& side = side_[own];
  const int slot =
      std::min(side.witnesses, most_witnesses - 1);  // when full, the last place is used again
  double* __restrict heights = side.heights.data() + static_cast<size_t>(slot) * faces.padded();
  double* __restrict bound = side.bound.data();
  faces.evaluate(point, heights);
  for (int f = 0; f < faces.padded(); ++f) bound[f] = heights[f] < bound[f] ? heights[f] : bound[f];
  side.witnesses = slot + 1;
}

/// Adds the corners of the axis' facet as witnesses, each for the faces of the other body.
void AxisSearch::add_witnesses_of(const ShapePair& pair, const SeparatingAxis& axis) {
  // Points near the facet give tight bounds for directions near the facet's own: for two edges
  // their ends, for a face its corners and the support vertex over it.
  if (axis.feature.kind == AxisKind::edges) {
    const CollisionShape::EdgeEnds edge_a = pair.shape[0]->edge_ends(axis.feature.a);
    const CollisionShape::EdgeEnds edge_b = pair.shape[1]->edge_ends(axis.feature.b);
    for (const int v : {edge_b.tail, edge_b.head})
      add_witness(pair, 0, pair.other[0] * pair.shape[1]->vertices().xyz(v));
    for (const int v : {edge_a.tail, edge_a.head})
      add_witness(pair, 1, pair.other[1] * pair.shape[0]->vertices().xyz(v));
    return;
  }
  const int own = axis.feature.reference();
  add_witness(pair, own, pair.other[own] * pair.shape[1 - own]->vertices().xyz(axis.support));
  const CollisionShape& shape = *pair.shape[own];
  const int face = axis.feature.face(), corners = shape.corner_count(face);
  // A few of a large face's corners are enough.
  const int stride = 1 + (corners - 1) / 4;
  for (int k = 0; k < corners; k += stride)
    add_witness(pair, 1 - own, pair.other[1 - own] * shape.corner(face, k).position);
}

/// Evaluates faces of body `own`, the one with the highest bound first, until no bound reaches the
/// best separation. Returns true as soon as a face separates the bodies.
bool AxisSearch::search_faces(const ShapePair& pair, int own, double alert) {
  Side& side = side_[own];
  const int padded = pair.shape[own]->faces().padded();
  const double margin = proof_margin(pair);
  while (true) {
    const int f = argmax(side.bound.data(), padded);
    if (!(side.bound[f] >= best_ - margin) || side.bound[f] == minus_infinity) return false;
    const FaceSeparation found = face_separation(pair, own, f, heights_);
    side.value[f] = found.separation;
    side.bound[f] = minus_infinity;
    if (found.separation >= best_) {
      best_ = found.separation;
      best_feature_ = AxisFeature::of_face(own, f);
      if (best_ > alert) return true;
    }
    // The vertex that is lowest over this face is also low over nearly parallel faces. As one more
    // witness it lowers their bounds.
    add_witness(pair, own, pair.other[own] * pair.shape[1 - own]->vertices().xyz(found.support));
  }
}

/// Collects the edges of body `own` that could still reach the best separation s: those whose arc
/// of normals has a direction that no witness rules out. On the arc n = m / |m| with
/// m = (1 - l) n_left + l n_right, 0 <= l <= 1, |m| <= 1. A witness w leaves the directions with
/// m.(w - edge) >= |m| s, hence >= min(s, 0). This is linear in l and equals at the ends the
/// heights of w over the two faces, so that each witness leaves an interval of l.
void AxisSearch::collect_edges(const ShapePair& pair, int own) {
  const CollisionShape& shape = *pair.shape[own];
  Side& side = side_[own];
  const size_t stride = shape.faces().padded();
  // 1e-8: the normal of nearly parallel edges is known to rounding / parallel_sine only.
  const double least = std::min(best_, 0.0) - 1e-8 * pair.size() - shape.bounds().planarity_error;
  side.edges.clear();
  for (int e = 0; e < shape.edge_count(); ++e) {
    const CollisionShape::EdgeEnds edge = shape.edge_ends(e);
    const double* heights = side.heights.data();
    double low = 0.0, high = 1.0;
    for (int k = 0; k < side.witnesses && low <= high; ++k, heights += stride) {
      // `left` and `right` are the witness' heights above `least` at l = 0 and l = 1. It leaves:
      //
      //     left >= 0, right >= 0: all of [0, 1]     left >= 0 > right: up to left / (left - right)
      //     left < 0, right < 0:   nothing           left < 0 <= right: from there on
      const double left = heights[edge.left] - least, right = heights[edge.right] - least;
      if (left < 0.0) low = right < 0.0 ? 2.0 : std::max(low, left / (left - right));
      if (left >= 0.0 && right < 0.0) high = std::min(high, left / (left - right));
    }
    if (low <= high) side.edges.push_back(e);
  }
}

bool AxisSearch::search_edges(const ShapePair& pair, double alert) {
  for (int own : {0, 1}) collect_edges(pair, own);
  const CollisionShape &a = *pair.shape[0], &b = *pair.shape[1];
  const Mat3& rotation = pair.other[0].rotation;
  turned_.clear();
  for (const int e : side_[1].edges) {
    const CollisionShape::Edge edge = b.edge(e);
    turned_.push_back({e, rotation * edge.along, -(rotation * edge.left_normal),
                       -(rotation * edge.right_normal)});
  }
  // A cheap test of the arcs comes first and lets doubtful pairs pass; edge_separation decides them
  // in its own rounding.
  const double blur = 1e-12;
  for (const int ea : side_[0].edges) {
    const CollisionShape::Edge edge = a.edge(ea);
    const double length_blur = blur * pair.size();
    for (const TurnedEdge& other : turned_) {
      // Two edges make a facet if each separates the ends of the other's arc: four signs tell.
      const double left_a = edge.left_normal.dot(other.along),
                   right_a = edge.right_normal.dot(other.along);
      if (std::min(left_a, right_a) > length_blur || std::max(left_a, right_a) < -length_blur)
        continue;
      const double left_b = other.left.dot(edge.along), right_b = other.right.dot(edge.along);
      if (std::min(left_b, right_b) > length_blur || std::max(left_b, right_b) < -length_blur)
        continue;
      const std::optional<EdgeSeparation> found = edge_separation(pair, ea, other.index, heights_);
      if (!found || !(found->separation >= best_ - tie_tolerance(pair))) continue;
      edge_pairs_.push_back({ea, other.index, found->separation});
      if (found->separation <= best_) continue;
      best_ = found->separation;
      best_feature_ = {AxisKind::edges, ea, other.index};
      if (best_ > alert) return true;
    }
  }
  return false;
}

/// Chooses among all axes within the tie tolerance of the best: faces before edges, a's before b's,
/// then the smallest index.
AxisFeature AxisSearch::choose(const ShapePair& pair) const {
  const double enough = best_ - tie_tolerance(pair);
  for (int own : {0, 1}) {
    const int count = pair.shape[own]->faces().count();
    for (int f = 0; f < count; ++f)
      if (side_[own].value[f] >= enough) return AxisFeature::of_face(own, f);
  }
  const EdgePair* first = nullptr;
  for (const EdgePair& candidate : edge_pairs_) {
    if (candidate.separation < enough) continue;
    if (!first || std::pair(candidate.a, candidate.b) < std::pair(first->a, first->b))
      first = &candidate;
  }
  return {AxisKind::edges, first->a, first->b};
}

}  // namespace ballast
