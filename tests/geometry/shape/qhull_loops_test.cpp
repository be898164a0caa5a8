#include "geometry/shape/qhull_loops.hpp"

#include <algorithm>
#include <set>

#include "geometry/shape/invalid_polyhedron.hpp"
#include "tests/catch.hpp"

using namespace ballast;

namespace {

/// The corners of a unit cube, bit 0 of the index: +x, bit 1: +y, bit 2: +z.
std::vector<double> cube_coordinates() {
  std::vector<double> coordinates;
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) coordinates.push_back(i >> axis & 1);
  return coordinates;
}

}  // namespace

TEST_CASE("a cube's faces are six squares, each once around") {
  std::vector<double> coordinates = cube_coordinates();
  const Loops loops = qhull_loops(coordinates, 1e-10);
  CHECK(coordinates == cube_coordinates());
  REQUIRE(loops.size() == 6);
  std::set<std::set<int>> faces;
  for (const std::vector<int>& loop : loops) {
    REQUIRE(loop.size() == 4);
    faces.insert(std::set<int>(loop.begin(), loop.end()));
    for (size_t k = 0; k < 4; ++k) {
      const int differing = loop[k] ^ loop[(k + 1) % 4];
      CHECK((differing == 1 || differing == 2 || differing == 4));  // along an edge of the cube
    }
  }
  CHECK(faces.size() == 6);
}

TEST_CASE("a corner raised by more than the merging length breaks the top into triangles") {
  std::vector<double> coordinates = cube_coordinates();
  coordinates[3 * 7 + 2] += 1e-7;
  CHECK(qhull_loops(coordinates, 1e-6).size() == 6);
  CHECK(qhull_loops(coordinates, 1e-10).size() == 7);
}

TEST_CASE("the complaint about flat points is one line") {
  std::vector<double> square = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  try {
    qhull_loops(square, 1e-10);
    FAIL("no complaint");
  } catch (const InvalidPolyhedron& error) {
    const std::string said = error.what();
    CHECK(said.size() > 10);
    CHECK(std::count(said.begin(), said.end(), '\n') <= 1);
  }
}
