#pragma once
// The memory of a pair that touches: the features that its axis and its contact points are computed
// from, in one place.
//
// From step to step nearly every touching pair keeps its axis and the two faces or edges that meet.
// Its shapes' tables lie scattered over megabytes; this memory is a few cache lines, read in the
// order of the pairs, and holds nothing that only few pairs read. Its answers equal, bit for bit,
// those of the tables, which decide whenever these copies cannot.

#include <array>
#include <variant>

#include "geometry/contact/contact_manifold.hpp"

namespace ballast {

class TouchingPair {
 public:
  /// Records a pair's best axis. `turn`: the sum of both bodies' MotionBound::turn. `heights`:
  /// scratch. Faces with too many corners are not recorded.
  void record(const ShapePair& pair, const SeparatingAxis& axis, double turn, Heights& heights);

  enum class PairOutcome { undecided, apart, touching };
  struct Answer {
    PairOutcome outcome = PairOutcome::undecided;
    /// apart: it separates by more than limits.alert, and only feature and separation are set.
    /// touching: it is proved to be the best; its clearance is a lower bound.
    SeparatingAxis axis = {};
    std::span<const ManifoldPoint> points = {};  ///< valid until the manifold is used again
  };
  /// Tests the pair in its present pose.
  Answer look(const PairFrame& pair, double turn, const ManifoldLimits& limits,
              ContactManifold& manifold) const;

 private:
  static constexpr size_t most = 4;  ///< faces with more corners are left to the shapes' tables

  /// The indices of a corner's vertex and edge.
  struct CornerNames {
    std::uint16_t vertex, edge;
  };
  /// A face of one body and the corners of the other body's face that lies on it.
  struct Faces {
    CollisionShape::Face reference;
    std::array<CollisionShape::Side, most> side;
    std::array<CornerNames, most> corner;
    int side_count, incident_count;
    std::array<CollisionShape::Corner, most> incident;
    /// The least height over the support vertex, when recorded, of those of the other body's
    /// vertices that are no corners of the incident face [m].
    double clearance;
    /// For each corner: by how much in cosine the incident face opposed the reference face more
    /// than any other face at that corner did.
    std::array<double, most> lead;
    double turn;  ///< sum of both bodies' MotionBound::turn when recorded. Heights have changed
                  ///< since by no more than its increase times the other body's diameter, cosines
                  ///< by no more than its increase.
  };
  /// A face beside an edge.
  struct Corners {
    int count;
    double offset;  ///< of the face's plane
    std::array<CollisionShape::Corner, most> corner;

    std::span<const CollisionShape::Corner> all() const {
      return {corner.data(), static_cast<size_t>(count)};
    }
  };
  /// Two edges and, if they are flat, the data needed of the faces beside them.
  struct Edges {
    CollisionShape::Edge a, b;
    int face[2];  ///< those faces; -1: not recorded
    Corners beside[2];
  };

  void record_edges(const ShapePair& pair, const SeparatingAxis& axis);
  void record_faces(const ShapePair& pair, int support, double turn, Heights& heights);
  Answer look_at(const Faces& faces, const PairFrame& pair, double turn,
                 const ManifoldLimits& limits, ContactManifold& manifold) const;
  Answer look_at(const Edges& edges, const PairFrame& pair, const ManifoldLimits& limits,
                 ContactManifold& manifold) const;

  AxisFeature feature_;
  std::variant<std::monostate, Faces, Edges> contact_;
};

}  // namespace ballast
