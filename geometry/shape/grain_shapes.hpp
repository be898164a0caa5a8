#pragma once
// Seeded grains that look like ballast: convex, angular, with 8 to 37 vertices and 12 to 70
// triangular faces, as in the paper (sec. 2).

#include <cstdint>
#include <vector>

#include "geometry/shape/mass_properties.hpp"

namespace ballast {

/// How the paper's "diameter" is read. Its own sentence ("the largest distance between the
/// barycenter and the vertices") makes it a radius; ballast practice (25-50 mm) makes it a
/// diameter, and the grain half as large.
enum class SizeConvention { radius, diameter };

/// Shape statistics in the range of digitised ballast. Axis ratios are those of the directions'
/// ellipsoid before the hull.
struct GrainShapeSettings {
  int min_vertices = 8,
      max_vertices = 37;  ///< of the finished hull; triangles: faces = 2 vertices - 4
  double elongation_min = 0.65, elongation_max = 1.0;  ///< intermediate / longest axis
  double flatness_min = 0.5, flatness_max = 0.85;      ///< shortest / longest axis
  double roughness = 0.06;  ///< relative standard deviation of the vertex radii: angularity
};

/// One class of the size distribution.
struct SizeClass {
  double size;      ///< the paper's "diameter" [m], read by the SizeConvention
  double fraction;  ///< by number; the fractions of a distribution sum to 1
};

/// 50 % of 2.5 cm, 34 % of 3.75 cm, 16 % of 5 cm (paper, sec. 2).
std::vector<SizeClass> paper_size_distribution();

/// One grain, in its principal frame, whose largest distance centre of mass - vertex is `radius`
/// [m]. Same seed, same grain, on every machine: the generator is our own, not the standard
/// library's distributions.
PrincipalShape make_grain(const GrainShapeSettings& settings, double radius, std::uint64_t seed);

/// A polyhedral "sphere" of the given circumradius [m]: the hull of an icosahedron subdivided
/// `subdivisions` times.
Polyhedron make_sphere(double radius, int subdivisions);

/// Makes `count` grains. Classes are filled by largest remainder and then shuffled by the seed, so
/// that the position in the list says nothing about the size.
std::vector<PrincipalShape> make_grains(int count, const std::vector<SizeClass>& distribution,
                                        SizeConvention convention,
                                        const GrainShapeSettings& settings, std::uint64_t seed);

}  // namespace ballast
