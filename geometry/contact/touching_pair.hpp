#pragma once
// What is remembered of a pair that touches: the records that its axis and its one contact point
// are computed from, in one place.
//
// From step to step nearly every touching pair keeps its axis and is one vertex over a face, or two
// edges across. Its shapes' tables lie scattered over megabytes; this is a few cache lines, read in
// the order of the pairs. What is computed here equals, bit for bit, what the tables give: a case
// that these records cannot decide is left to them.

#include <array>
#include <variant>

#include "geometry/contact/contact_manifold.hpp"

namespace ballast {

/// A vertex of one body over a face of the other.
struct VertexOnFace {
  static constexpr int most_sides = 4;  ///< faces with more are left to the tables
  CollisionShape::Face face;
  std::array<CollisionShape::Side, most_sides> sides;
  Vec3 vertex;
  int support;
  double clearance;  ///< when recorded [m]
  double turn;  ///< of both bodies until then (Travel): the clearance shrinks by no more than what
                ///< they turn after that times the other body's diameter
};

struct EdgeAcrossEdge {
  static constexpr int most_sides = 4;
  struct Beside {
    int face = -1;  ///< -1: none, or too many sides
    int own = 0, count = 0;
    std::array<CollisionShape::Side, most_sides> sides;
  };
  CollisionShape::Edge a, b;
  Beside beside_a, beside_b;  ///< the faces that looked along the axis most
};

class TouchingPair {
 public:
  /// Records a pair's best axis; `turn`: the two bodies' sum. Another kind of contact leaves
  /// nothing.
  void record(const ShapePair& pair, const SeparatingAxis& axis, double turn);

  enum class Look { undecided, apart, touching };
  /// apart: the axis separates by more than `alert`. touching: the axis is proved to be the best,
  /// and `point` is the manifold. axis.clearance is then a lower bound.
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
