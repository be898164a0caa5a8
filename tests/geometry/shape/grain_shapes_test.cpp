#include "geometry/shape/grain_shapes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/geometry/shape/support_vertex.hpp"

using namespace ballast;

namespace {

bool same_bits(const PrincipalShape& a, const PrincipalShape& b) {
  return std::equal(a.shape.vertices().begin(), a.shape.vertices().end(),
                    b.shape.vertices().begin(), b.shape.vertices().end()) &&
         a.volume == b.volume && a.inertia == b.inertia &&
         a.shape.face_count() == b.shape.face_count();
}

/// The extents along the principal axes, longest first.
std::array<double, 3> extents(const Polyhedron& p) {
  std::array<double, 3> length;
  for (int x = 0; x < 3; ++x)
    length[x] = support_vertex(p, Vec3::Unit(x))[x] - support_vertex(p, -Vec3::Unit(x))[x];
  std::sort(length.rbegin(), length.rend());
  return length;
}

}  // namespace

TEST_CASE("two thousand grains stay within the paper's ranges and look like ballast") {
  const int n = 2000;
  const double radius = 0.0125;
  int fewest = 1000, most = 0;
  double fill = 0.0, elongation = 0.0, flatness = 0.0;
  for (int seed = 0; seed < n; ++seed) {
    const PrincipalShape grain = make_grain({}, radius, seed);
    const Polyhedron& p = grain.shape;
    fewest = std::min(fewest, p.vertex_count());
    most = std::max(most, p.vertex_count());
    REQUIRE(p.face_count() == 2 * p.vertex_count() - 4);
    REQUIRE(p.circumradius() == Approx(radius).epsilon(1e-14));
    REQUIRE(p.inradius() > 0.1 * radius);
    fill += grain.volume / (4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3)) / n;
    const auto [length, width, height] = extents(p);
    elongation += width / length / n;
    flatness += height / length / n;
  }
  CAPTURE(fill, elongation, flatness);
  CHECK(fewest == 8);  // both ends of the range occur: 8-37 vertices, 12-70 faces
  CHECK(most == 37);
  CHECK((fill > 0.25 && fill < 0.45));
  CHECK((elongation > 0.7 && elongation < 0.9));
  CHECK((flatness > 0.5 && flatness < 0.75));
}

TEST_CASE("same seed, same grain, another seed, another grain") {
  for (int seed = 0; seed < 50; ++seed) {
    CHECK(same_bits(make_grain({}, 0.02, seed), make_grain({}, 0.02, seed)));
    CHECK_FALSE(same_bits(make_grain({}, 0.02, seed), make_grain({}, 0.02, seed + 1)));
  }
}

TEST_CASE("settings narrow the grains, and impossible ones are refused") {
  GrainShapeSettings narrow;
  narrow.min_vertices = narrow.max_vertices = 12;
  for (int seed = 0; seed < 30; ++seed)
    CHECK(make_grain(narrow, 1.0, seed).shape.face_count() == 20);
  for (const GrainShapeSettings& bad : {GrainShapeSettings{.min_vertices = 3},
                                        {.max_vertices = 7},
                                        {.flatness_min = 0.0},
                                        {.roughness = std::nan("")}})
    CHECK_THROWS_AS(make_grain(bad, 1.0, 0), std::invalid_argument);
  for (const double radius : {0.0, std::nan("")})
    CHECK_THROWS_AS(make_grain({}, radius, 0), std::invalid_argument);
}

TEST_CASE("spheres") {
  double previous = 0.0;
  for (int level = 0; level <= 4; ++level) {
    const Polyhedron sphere = make_sphere(2.0, level);
    CHECK(sphere.face_count() == 20 << (2 * level));
    CHECK(sphere.vertex_count() == 2 + (10 << (2 * level)));
    for (const Vec3& p : sphere.vertices()) CHECK(p.norm() == Approx(2.0).epsilon(1e-15));
    CHECK(sphere.inradius() > previous);
    previous = sphere.inradius();
  }
  CHECK(previous > 0.998 * 2.0);
  CHECK_THROWS_AS(make_sphere(-1.0, 1), std::invalid_argument);
  CHECK_THROWS_AS(make_sphere(1.0, 9), std::invalid_argument);
}

TEST_CASE("a sample has the paper's classes, mixed") {
  const auto count_of = [](const std::vector<PrincipalShape>& grains, double radius) {
    return std::count_if(grains.begin(), grains.end(), [&](const PrincipalShape& g) {
      return std::abs(g.shape.circumradius() - radius) < 1e-6 * radius;
    });
  };
  const auto grains = make_grains(1200, paper_size_distribution(), SizeConvention::diameter, {}, 7);
  REQUIRE(grains.size() == 1200);
  CHECK(count_of(grains, 0.0125) == 600);
  CHECK(count_of(grains, 0.01875) == 408);
  CHECK(count_of(grains, 0.025) == 192);
  // Sizes are mixed: the first half has about half of each class (five standard deviations).
  const std::vector<PrincipalShape> half(grains.begin(), grains.begin() + 600);
  CHECK(std::abs(count_of(half, 0.0125) - 300) < 44);
  CHECK(std::abs(count_of(half, 0.025) - 96) < 32);

  const auto again = make_grains(1200, paper_size_distribution(), SizeConvention::diameter, {}, 7);
  CHECK(std::equal(grains.begin(), grains.end(), again.begin(), same_bits));
  CHECK_FALSE(same_bits(
      make_grains(1, paper_size_distribution(), SizeConvention::diameter, {}, 8)[0], grains[0]));

  const auto large = make_grains(10, paper_size_distribution(), SizeConvention::radius, {}, 7);
  CHECK(count_of(large, 0.025) == 5);
  CHECK(count_of(large, 0.0375) == 3);  // 3.4 and 1.6: the tenth grain goes to the larger remainder
  CHECK(count_of(large, 0.05) == 2);
  CHECK(make_grains(0, paper_size_distribution(), SizeConvention::radius, {}, 7).empty());
}

TEST_CASE("distributions that make no sense are refused") {
  for (const auto& classes : std::vector<std::vector<SizeClass>>{
           {{0.02, 0.5}}, {}, {{0.02, 1.5}, {0.03, -0.5}}, {{-0.02, 1.0}}})
    CHECK_THROWS_AS(make_grains(3, classes, SizeConvention::radius, {}, 1), std::invalid_argument);
  CHECK_THROWS_AS(make_grains(-1, paper_size_distribution(), SizeConvention::radius, {}, 1),
                  std::invalid_argument);
}
