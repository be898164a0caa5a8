#include "geometry/shape/grain_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/pose.hpp"

namespace ballast {

namespace {

void check(const GrainShapeSettings& s) {
  // The axes of a grain's ellipsoid: 1 >= elongation >= flatness > 0, relative to the longest.
  const bool ratios_ok = 0.0 < s.elongation_min && s.elongation_min <= s.elongation_max &&
                         s.elongation_max <= 1.0 && 0.0 < s.flatness_min &&
                         s.flatness_min <= s.flatness_max && s.flatness_max <= 1.0 &&
                         s.flatness_min <= s.elongation_min;
  if (!ratios_ok)
    throw std::invalid_argument(
        "grain shape: need 0 < flatness_min <= elongation_min, min <= max <= 1");
  if (s.min_vertices < 4 || s.max_vertices < s.min_vertices)
    throw std::invalid_argument("grain shape: need 4 <= min_vertices <= max_vertices");
  if (!(s.roughness >= 0.0 && s.roughness < 0.15))  // 6 deviations must leave a positive radius
    throw std::invalid_argument("grain shape: roughness must lie in [0, 0.15)");
}

/// `count` directions, each the one of six candidates that is farthest from those before it
/// (Mitchell 1991): irregular but without clusters, as on a crushed stone.
std::vector<Vec3> spread_directions(int count, Random& random) {
  std::vector<Vec3> directions{random_direction(random)};
  while (static_cast<int>(directions.size()) < count) {
    Vec3 best = Vec3::Zero();
    double best_cosine = 2.0;  // of the angle to the nearest direction so far
    for (int candidate = 0; candidate < 6; ++candidate) {
      const Vec3 d = random_direction(random);
      double cosine = -1.0;
      for (const Vec3& other : directions) cosine = std::max(cosine, d.dot(other));
      if (cosine >= best_cosine) continue;
      best_cosine = cosine;
      best = d;
    }
    directions.push_back(best);
  }
  return directions;
}

/// One attempt at a grain: an ellipsoid of random axis ratios, roughened, and the hull of points on
/// it. Empty when the hull has too few or too many vertices, or a face that is no triangle.
std::optional<Polyhedron> try_grain(const GrainShapeSettings& s, Random& random) {
  // a few more directions than vertices wanted: some end inside the hull
  const int count = s.min_vertices + random.below(s.max_vertices + 4 - s.min_vertices);
  const double elongation = random.uniform(s.elongation_min, s.elongation_max);
  const double flatness = random.uniform(s.flatness_min, std::min(s.flatness_max, elongation));
  const Vec3 axes(1.0, elongation, flatness);
  std::vector<Vec3> points;
  for (const Vec3& d : spread_directions(count, random))
    points.push_back((1.0 + s.roughness * random.normal()) * axes.cwiseProduct(d));
  Polyhedron hull = convex_hull(points);
  const int vertices = hull.vertex_count();
  if (vertices < s.min_vertices || vertices > s.max_vertices) return std::nullopt;
  // With triangles alone 3 F = 2 E, and Euler's V - E + F = 2 gives F = 2 V - 4. With fewer faces
  // some are larger polygons.
  if (hull.face_count() != 2 * vertices - 4) return std::nullopt;
  return hull;
}

Polyhedron scaled(const Polyhedron& shape, double factor) {
  std::vector<Vec3> vertices;
  for (const Vec3& p : shape.vertices()) vertices.push_back(factor * p);
  return shape.with_vertices(std::move(vertices));
}

/// Numbers per class: whole parts first, the rest to the largest remainders (the earlier class
/// among equals).
std::vector<int> class_counts(int count, const std::vector<SizeClass>& distribution) {
  std::vector<int> counts;
  std::vector<double> remainders;
  for (const SizeClass& c : distribution) {
    // 1e-9: a product such as 0.34 * 50 that rounds to just below 17 is 17
    counts.push_back(static_cast<int>(std::floor(c.fraction * count + 1e-9)));
    remainders.push_back(c.fraction * count - counts.back());
  }
  std::vector<size_t> order(distribution.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return remainders[a] > remainders[b]; });
  int missing = count - std::accumulate(counts.begin(), counts.end(), 0);
  for (size_t k = 0; missing > 0; k = (k + 1) % order.size(), --missing) ++counts[order[k]];
  return counts;
}

}  // namespace

std::vector<SizeClass> paper_size_distribution() {
  return {{0.025, 0.50}, {0.0375, 0.34}, {0.05, 0.16}};
}

PrincipalShape make_grain(const GrainShapeSettings& settings, double radius, std::uint64_t seed) {
  check(settings);
  if (!(radius > 0.0 && std::isfinite(radius)))
    throw std::invalid_argument("grain shape: radius must be positive");
  Random random(seed);
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const std::optional<Polyhedron> hull = try_grain(settings, random);
    if (!hull) continue;
    // Only in the principal frame is the centre of mass, from which the radius is measured, at the
    // origin. The scaled grain is transformed once more for its own volume and moments.
    const Polyhedron principal = to_principal_frame(*hull).shape;
    return to_principal_frame(scaled(principal, radius / principal.circumradius()));
  }
  throw InvalidPolyhedron(
      "grain shape: no hull with the wanted number of vertices in 1000 attempts");
}

Polyhedron make_sphere(double radius, int subdivisions) {
  if (!(radius > 0.0 && std::isfinite(radius)) || subdivisions < 0 || subdivisions > 5)
    throw std::invalid_argument("sphere: need radius > 0 and 0 to 5 subdivisions");
  // The corners of an icosahedron are (0, +-1, +-g) and their cyclic permutations, with the golden
  // ratio g. All have the same distance from the origin.
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  std::vector<Vec3> points;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-golden, golden})
      points.insert(points.end(), {Vec3(0.0, a, b), Vec3(a, b, 0.0), Vec3(b, 0.0, a)});
  for (Vec3& p : points) p *= radius / p.norm();
  Polyhedron sphere = convex_hull(points);
  for (int level = 0; level < subdivisions; ++level) {
    // The middle of every edge is pushed out to the sphere: four triangles replace each triangle.
    for (const Polyhedron::Edge& edge : sphere.edges()) {
      const Vec3 middle = sphere.vertex(edge.tail) + sphere.vertex(edge.head);
      points.push_back(middle * (radius / middle.norm()));
    }
    sphere = convex_hull(points);
  }
  return sphere;
}

std::vector<PrincipalShape> make_grains(int count, const std::vector<SizeClass>& distribution,
                                        SizeConvention convention,
                                        const GrainShapeSettings& settings, std::uint64_t seed) {
  double sum = 0.0;
  for (const SizeClass& c : distribution) {
    if (!(c.size > 0.0 && c.fraction >= 0.0))
      throw std::invalid_argument("size distribution: negative size or fraction");
    sum += c.fraction;
  }
  if (count < 0 || !(std::abs(sum - 1.0) < 1e-9))
    throw std::invalid_argument("size distribution: the fractions must sum to 1");

  // The distribution fixes how many of each class there are; only order and shapes are random.
  std::vector<double> radii;
  const std::vector<int> counts = class_counts(count, distribution);
  for (size_t c = 0; c < distribution.size(); ++c) {
    const double radius =
        convention == SizeConvention::radius ? distribution[c].size : 0.5 * distribution[c].size;
    radii.insert(radii.end(), counts[c], radius);
  }
  Random random(seed);
  for (int i = count - 1; i > 0; --i)
    std::swap(radii[i], radii[random.below(i + 1)]);  // Fisher-Yates

  std::vector<PrincipalShape> grains;
  for (const double radius : radii) grains.push_back(make_grain(settings, radius, random.next()));
  return grains;
}

}  // namespace ballast
