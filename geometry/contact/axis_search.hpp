#pragma once
// The best separating axis of a pair. Last step's axis is kept if it is proved to be the best one
// again; otherwise an exact search finds it, which evaluates only facets whose upper bound reaches
// the best one so far.

#include <vector>

#include "geometry/contact/separating_axis.hpp"

namespace ballast {

enum class AxisOutcome {
  separated_by_hint,  ///< the hint's separation exceeds the alert distance
  proved_by_hint,     ///< the hint is the best axis
  separated,          ///< the search found a facet that separates the bodies
  found               ///< the best axis, found by the search
};
inline bool is_separated(AxisOutcome outcome) {
  return outcome == AxisOutcome::separated_by_hint || outcome == AxisOutcome::separated;
}

/// Finds the best axis of a pair. Holds scratch memory, so each thread needs its own.
class AxisSearch {
 public:
  /// `shapes`: all shapes that will be searched; they determine the size of the scratch memory.
  explicit AxisSearch(std::span<const CollisionShape> shapes);

  /// Finds the best axis of the pair. As soon as the separation along some facet exceeds `alert`
  /// [m], the bodies are separated and the search stops; it then sets only the separation of
  /// `axis`, to that of this facet. `hint`: a facet of any kind, or none, to start from; on return
  /// the facet that decided. Whether the bodies are separated and, if not, the axis do not depend
  /// on the hint, to the last bit.
  AxisOutcome find(const ShapePair& pair, double alert, AxisFeature& hint, SeparatingAxis& axis);

 private:
  /// Bounds and values of one body's facets during a search. A witness w is a point of the other
  /// body, in this body's frame. The other body's lowest point over a face f is at most as high as
  /// w, so that s(n_f) <= n_f.w - offset_f.
  struct Side {
    std::vector<double> bound;  // per face: upper bound of its separation; -infinity once evaluated
    std::vector<double> value;  // per face: its separation, -infinity unless evaluated
    std::vector<double> heights;  // per witness and face: n_f.w - offset_f
    std::vector<int> edges;       // the edges that the witnesses do not rule out
    int witnesses = 0;
  };
  struct EdgePair {
    int a, b;
    double separation;
  };
  /// An edge of b in a's frame, with its arc of normals reversed.
  struct TurnedEdge {
    int index;
    Vec3 along, left, right;
  };

  AxisOutcome search(const ShapePair& pair, double alert, const SeparatingAxis* start,
                     AxisFeature& hint, SeparatingAxis& axis);
  void start_side(const ShapePair& pair, int own);
  void add_witness(const ShapePair& pair, int own, const Vec3& point);
  void add_witnesses_of(const ShapePair& pair, const SeparatingAxis& axis);
  bool search_faces(const ShapePair& pair, int own, double alert);
  void collect_edges(const ShapePair& pair, int own);
  bool search_edges(const ShapePair& pair, double alert);
  AxisFeature choose(const ShapePair& pair) const;

  static constexpr int most_witnesses = 12;
  Heights heights_;
  Side side_[2];
  std::vector<EdgePair> edge_pairs_;  // evaluated pairs that came near or above the best so far
  std::vector<TurnedEdge> turned_;
  double best_ = 0.0;  // largest separation so far
  AxisFeature best_feature_;
};

}  // namespace ballast
