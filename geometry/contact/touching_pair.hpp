#pragma once
// The memory of a pair that touches: the features that its axis and its contact points are computed
// from, in one place.
//
// From step to step nearly every touching pair keeps its axis and the two faces or edges that meet.
// Its shapes' tables lie scattered over megabytes; this memory is a few cache lines, read in the
// order of the pairs. Its answers equal, bit for bit, those of the tables, which decide whenever
// these copies cannot.

#include <array>
#include <variant>

#include "geometry/contact/contact_manifold.hpp"

namespace ballast {

/// A copy of a face that has few corners.
struct FaceCopy {
  static constexpr size_t most = 4;  ///< faces with more are left to the shapes' tables
  int index = -1;                    ///< of the face in its shape; -1: nothing is kept
  int count = 0;
  CollisionShape::Face face;
  std::array<CollisionShape::Side, most> side;
  std::array<CollisionShape::Corner, most> corner;

  /// False, and nothing is kept, if there are too many corners.
  bool take(const CollisionShape& shape, int f);
  CollisionShape::FaceView view() const {
    const size_t n = static_cast<size_t>(count);
    return {face, {corner.data(), n}, {side.data(), n}};
  }
};

class TouchingPair {
 public:
  /// Records a pair's best axis. `turn`: the sum of both bodies' Travel::turn. `heights`: scratch.
  /// Faces with too many corners are not recorded.
  void record(const ShapePair& pair, const SeparatingAxis& axis, double turn, Heights& heights);

  enum class Look { undecided, apart, touching };
  /// Looks at the pair in its present pose.
  /// apart: the axis separates by more than `alert` [m]; of `axis` the separation is set.
  /// touching: the axis is proved to be the best, and `points` are its points; axis.clearance is
  /// then a lower bound. They are valid until the manifold is asked again.
  Look look(const PairFrame& pair, double turn, double alert, int max_points,
            ContactManifold& manifold, SeparatingAxis& axis,
            std::span<const ManifoldPoint>& points) const;

 private:
  /// A face of one body and the face of the other that lies on it.
  struct Faces {
    FaceCopy reference, incident;
    /// Of the other body's vertices that are no corners of the incident face: how much higher than
    /// the lowest corner they were when recorded [m].
    double clearance;
    /// Of each corner: by how much in cosine the incident face opposed the reference face more than
    /// any other face at that corner did.
    std::array<double, FaceCopy::most> lead;
    double turn;  ///< of both bodies until then (Travel). Since then, heights have changed by no
                  ///< more than the turn times the other body's diameter, cosines by no more than
                  ///< the turn.
  };
  /// Two edges and, of the faces beside each, the one that looked along the axis most.
  struct Edges {
    struct Beside {
      FaceCopy face;
      int own = 0;  ///< the side that stands on the edge
    };
    CollisionShape::Edge a, b;
    Beside beside_a, beside_b;
  };

  void record_faces(const ShapePair& pair, int support, double turn, Heights& heights);
  Look look_at(const Faces& faces, const PairFrame& pair, double turn, double alert, int max_points,
               ContactManifold& manifold, SeparatingAxis& axis,
               std::span<const ManifoldPoint>& points) const;
  Look look_at(const Edges& edges, const PairFrame& pair, double alert, int max_points,
               ContactManifold& manifold, SeparatingAxis& axis,
               std::span<const ManifoldPoint>& points) const;

  AxisFeature feature_;
  std::variant<std::monostate, Faces, Edges> contact_;
};

}  // namespace ballast
