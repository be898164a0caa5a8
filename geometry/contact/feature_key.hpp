#pragma once
// Names of the places where two bodies touch, by which a contact point is known from step to step.

#include <cstdint>

namespace ballast {

/// The features that meet at a point. They do not name the reference face, so that a point keeps
/// its key when the reference changes from one body's face to the other's, or to the face beside
/// it.
enum class PointKind : std::uint8_t {
  vertex_of_a,  ///< a vertex of a over a face of b: the index in a, nothing in b
  vertex_of_b,
  edges,  ///< an edge of each
  sides   ///< two sides of the reference face that share no corner: left behind by rounding only
};

/// The kind stands in the two top bits, then 31 bits for the index in each body. A vertex of b has
/// the vertex's own number as its key.
inline std::uint64_t feature_key(PointKind kind, int a, int b) {
  constexpr std::uint64_t code[] = {1, 0, 2, 3};
  return code[static_cast<int>(kind)] << 62 | static_cast<std::uint64_t>(a) << 31 |
         static_cast<std::uint64_t>(b);
}

/// Vertex `index` of body 0 (a) or 1 (b).
inline std::uint64_t vertex_key(int body, int index) {
  return body == 0 ? feature_key(PointKind::vertex_of_a, index, 0)
                   : feature_key(PointKind::vertex_of_b, 0, index);
}

/// Edge `own` of body 0 (a) or 1 (b) and edge `other` of the other body.
inline std::uint64_t edges_key(int body, int own, int other) {
  return body == 0 ? feature_key(PointKind::edges, own, other)
                   : feature_key(PointKind::edges, other, own);
}

}  // namespace ballast
