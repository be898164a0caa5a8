#pragma once
// Shapes, pair configurations and the slow obvious oracle that contact detection is tested against.

#include <string>
#include <vector>

#include "geometry/contact/contact_manifold.hpp"
#include "geometry/shape/pose.hpp"

namespace ballast::testing {

/// Tetrahedra, boxes (also as 12 triangles), prisms, plates, needles, grains, polyhedral spheres;
/// sizes 1 to 10 cm.
const std::vector<Polyhedron>& shape_pool();
/// The same shapes laid out for detection, in the same order.
const std::vector<CollisionShape>& collision_pool();
/// A face of the shape with its loop.
CollisionShape::FaceTable face_table(const CollisionShape& shape, int face);

/// A rotation that brings the direction `from` to the direction `to`, by the least angle. Eigen's
/// FromTwoVectors() takes a singular value decomposition, and compilers seven seconds for it.
Quat turned_onto(const Vec3& from, const Vec3& to);

Polyhedron prism(int sides, double radius, double height);

/// A pair's best axis, and its normal and points; without points when the bodies are more than
/// `alert` apart.
struct Contact {
  SeparatingAxis axis;
  Vec3 normal;
  std::vector<ManifoldPoint> points;
};
Contact contact_of(const ShapePair& pair, double alert, int max_points = 1000);

/// Separation of two polyhedra by all face normals and all cross products of edges (but parallel
/// ones), each with the full support functions of both.
struct BruteForce {
  double facets;  ///< largest over face normals and those cross products at which both edges are
                  ///< supports
  double all;     ///< largest over every axis
  Vec3 normal;    ///< of `all`: world frame, from a to b
  bool near_parallel;  ///< some pair of edges is nearly but not quite parallel
};
BruteForce brute_force(const Polyhedron& a, const Polyhedron& b, const RelativePose& b_in_a);

/// How a pair of bodies is placed, one kind for each trouble.
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
/// An edge of each at this angle [rad], shapes and gap at random.
PairCase edges_together(double angle, Random& random);

/// A length of 10^-low .. 10^-high, either sign, or sometimes zero.
double random_scale(Random& random, double low, double high);

}  // namespace ballast::testing
