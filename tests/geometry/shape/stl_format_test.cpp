#include "geometry/shape/stl_format.hpp"

#include <set>

#include "geometry/shape/grain_shapes.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/shape/mesh_test_files.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;
using raw_mesh::RawMesh;

namespace {

RawMesh read_stl_text(std::string_view content) { return raw_mesh::read_stl("a.stl", content); }

/// One facet of a text STL.
std::string facet(const std::string& p, const std::string& q, const std::string& r) {
  return "facet normal 0 0 0\nouter loop\nvertex " + p + "\nvertex " + q + "\nvertex " + r +
         "\nendloop\nendfacet\n";
}

}  // namespace

TEST_CASE("STL: text and binary hold the same triangles of welded corners") {
  const Polyhedron grain = make_grain({}, 0.02, 5).shape;  // all faces are triangles
  const RawMesh text = read_stl_text(stl_text(grain)), binary = read_stl_text(binary_stl(grain));
  for (const RawMesh* mesh : {&text, &binary}) {
    REQUIRE(static_cast<int>(mesh->vertices.size()) == grain.vertex_count());
    REQUIRE(static_cast<int>(mesh->faces.size()) == grain.face_count());
    const double rounding = mesh == &text ? 0.0 : 1e-8;
    for (int f = 0; f < grain.face_count(); ++f)
      for (int k = 0; k < 3; ++k)
        CHECK((mesh->vertices[mesh->faces[f][k]] - grain.vertex(grain.face(f)[k])).norm() <=
              rounding);
  }
  CHECK(text.face_lines[1] == 9);  // 7 lines a facet, after the line "solid"
  CHECK(std::set<int>(binary.face_lines.begin(), binary.face_lines.end()) == std::set<int>{0});
}

TEST_CASE("STL: corners weld to a millionth of the size, not farther") {
  const auto vertices_with = [](const std::string& near_corner) {
    const std::string text = "solid\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                             facet(near_corner, "0 1 0", "0 0 1") + "endsolid\n";
    return read_stl_text(text).vertices.size();
  };
  CHECK(vertices_with("1 0 0") == 4);
  CHECK(vertices_with("1 0 9e-7") == 4);
  CHECK(vertices_with("1 0 2e-6") == 5);
}

TEST_CASE("STL: damage is named") {
  const std::string binary = binary_stl(make_box({1, 2, 3}));
  CHECK_THROWS_WITH(read_stl_text(binary.substr(0, binary.size() - 1)),
                    Catch::Matchers::Contains("12 triangles take 684 bytes, the file has 683"));
  CHECK_THROWS_WITH(read_stl_text("solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0 x\n"),
                    "a.stl: line 4: 'x' is no number in range");
  CHECK_THROWS_WITH(read_stl_text("solid\n" + facet("0 0 0", "1 0 0", "0 1 0")),
                    Catch::Matchers::Contains("the file ends where 'facet' or 'endsolid'"));
}
