#pragma once
// The memory of a pair that touches: the records that its axis and its one contact point are
// computed from, in one place.
//
// From step to step nearly every touching pair keeps its axis and is one vertex over a face, or two
// edges across. Its shapes' tables lie scattered over megabytes; this memory is a few cache lines,
// read in the order of the pairs. Its answers equal, bit for bit, those of the tables, which decide
// whenever these records cannot.

#include <array>
#include <variant>

#include "geometry/contact/lone_point.hpp"

namespace ballast {

/// The planes on the sides of a face that has few of them.
struct FewSides {
  static constexpr size_t most = 4;  ///< faces with more are left to the shapes' tables
  int count = 0;
  std::array<CollisionShape::Side, most> side;

  /// False, and nothing is kept, if there are too many.
  bool keep(std::span<const CollisionShape::Side> sides);
  std::span<const CollisionShape::Side> all() const {
    return {side.data(), static_cast<size_t>(count)};
  }
};

/// A vertex of one body over a face of the other.
struct VertexOnFace {
  CollisionShape::Face face;
  FewSides sides;
  Vec3 vertex;       ///< in its own body's frame [m]
  int support;       ///< its index
  double clearance;  ///< when recorded [m]
  double turn;  ///< of both bodies until then (Travel): the clearance shrinks by no more than the
                ///< turn after that times the other body's diameter
};

/// Two edges and, of the faces beside each, the one that looked along the axis most.
struct EdgeAcrossEdge {
  struct Beside {
    int face = -1;  ///< -1: the face has too many sides
    int own = 0;    ///< the side that stands on the edge
    FewSides sides;
  };
  CollisionShape::Edge a, b;
  Beside beside_a, beside_b;
};

class TouchingPair {
 public:
  /// Records a pair's best axis. `turn`: the sum of both bodies' Travel::turn. A face with too many
  /// sides is not recorded.
  void record(const ShapePair& pair, const SeparatingAxis& axis, double turn);

  enum class Look { undecided, apart, touching };
  /// Looks at the pair in its present pose.
  /// apart: the axis separates by more than `alert` [m]; of `axis` the separation is set.
  /// touching: the axis is proved to be the best and `point` is the only point; axis.clearance is
  /// then a lower bound.
  Look look(const PairFrame& pair, double turn, double alert, SeparatingAxis& axis,
            ManifoldPoint& point) const;

 private:
  Look look_at(const VertexOnFace& contact, const PairFrame& pair, double turn, double alert,
               SeparatingAxis& axis, ManifoldPoint& point) const;
  Look look_at(const EdgeAcrossEdge& contact, const PairFrame& pair, double alert,
               SeparatingAxis& axis, ManifoldPoint& point) const;

  AxisFeature feature_;
  std::variant<std::monostate, VertexOnFace, EdgeAcrossEdge> contact_;
};

}  // namespace ballast
