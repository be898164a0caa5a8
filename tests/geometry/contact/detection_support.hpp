#pragma once
// Shapes, pair configurations and the slow, simple oracle for the tests of contact detection.

#include <string>
#include <vector>

#include "geometry/contact/contact_manifold.hpp"
#include "geometry/shape/pose.hpp"

namespace ballast::testing {

/// Tetrahedra, boxes (also as 12 triangles), prisms, plates, needles, grains, polyhedral spheres;
/// sizes 1 to 10 cm.
const std::vector<Polyhedron>& shape_pool();
/// The same shapes in the form for detection, in the same order.
const std::vector<CollisionShape>& collision_pool();
/// The table of a face of the shape, with its loop.
CollisionShape::FaceTable face_table(const CollisionShape& shape, int face);

/// The rotation by the least angle that turns the direction `from` to `to`. Eigen's
/// FromTwoVectors() uses a singular value decomposition, which takes compilers seven seconds.
Quat turned_onto(const Vec3& from, const Vec3& to);

Polyhedron prism(int sides, double radius, double height);

/// The best axis of a pair, its normal and its points; no points if the bodies are more than
/// `alert` apart.
struct Contact {
  SeparatingAxis axis;
  Vec3 normal;
  std::vector<ManifoldPoint> points;
};
Contact contact_of(const ShapePair& pair, double alert, int max_points = 1000);

/// Separation of two polyhedra along all face normals and all cross products of edges (except
/// parallel ones), each with the full support functions of both.
struct BruteForce {
  double facets;  ///< largest over face normals and those cross products at which both edges are
                  ///< supports
  double all;     ///< largest over every axis
  Vec3 normal;    ///< of `all`: world frame, from a to b
  bool near_parallel;  ///< some pair of edges is nearly but not quite parallel
};
BruteForce brute_force(const Polyhedron& a, const Polyhedron& b, const RelativePose& b_in_a);

/// The placement of a pair of bodies: one for each kind of difficulty.
enum class Placement {
  near_touching,   ///< random orientation, gap +-1e-12 .. +-1e-3 m or about zero
  deep,            ///< centres close
  parallel_faces,  ///< a face of one on a face of the other, random shift in the plane, gap as
                   ///< near_touching
  parallel_edges,  ///< an edge of each parallel or at an angle of 3e-7 .. 1e-2, near touching
  offset_copy,     ///< the same shape twice, moved and turned by 0 or 1e-14 .. 1e-2
  inside,          ///< one within the other
  apart            ///< up to a few diameters
};
constexpr Placement placements[] = {Placement::near_touching,  Placement::deep,
                                    Placement::parallel_faces, Placement::parallel_edges,
                                    Placement::offset_copy,    Placement::inside,
                                    Placement::apart};
std::string name(Placement placement);

struct PairCase {
  int a, b;  ///< indices into the pools
  RelativePose b_in_a;
  ShapePair pair() const { return ShapePair(collision_pool()[a], collision_pool()[b], b_in_a); }
  double size() const { return pair().size(); }
};
PairCase random_case(Placement placement, Random& random);
/// A pair with an edge of each at this angle [rad]; shapes and gap are random.
PairCase edges_together(double angle, Random& random);

/// A random number of size 10^-low .. 10^-high, of either sign, or sometimes zero.
double random_scale(Random& random, double low, double high);

}  // namespace ballast::testing
