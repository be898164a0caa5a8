#include "geometry/shape/obj_format.hpp"

#include "geometry/shape/grain_shapes.hpp"
#include "tests/catch.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;
using raw_mesh::RawMesh;

namespace {

RawMesh read_obj_text(std::string_view text) { return raw_mesh::read_obj("a.obj", text); }

}  // namespace

TEST_CASE("OBJ: what was written is read, bit for bit and in order") {
  const Polyhedron grain = make_grain({}, 0.02, 5).shape;
  const RawMesh mesh = read_obj_text(obj_text(grain));
  REQUIRE(mesh.vertices.size() == grain.vertices().size());
  REQUIRE(static_cast<int>(mesh.faces.size()) == grain.face_count());
  for (int v = 0; v < grain.vertex_count(); ++v) CHECK(mesh.vertices[v] == grain.vertex(v));
  for (int f = 0; f < grain.face_count(); ++f)
    CHECK(mesh.faces[f] == std::vector<int>(grain.face(f).begin(), grain.face(f).end()));
}

TEST_CASE("OBJ: each vertex and face knows its line") {
  const RawMesh mesh =
      read_obj_text("# by hand\nv 0 0 0\n\nv 1 0 0\nvn 0 0 1\nv 0 1 0 # last\nf 1 2 3\n");
  CHECK(mesh.vertex_lines == std::vector<int>{2, 4, 6});
  CHECK(mesh.face_lines == std::vector<int>{7});
  CHECK(mesh.vertices[1] == Vec3(1, 0, 0));
}

TEST_CASE("OBJ: the three ways to name a corner mean the same vertex") {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  for (const char* face : {"f 2 3 4", "f -3 -2 -1", "f 2/9 3//9 4/9/9"}) {
    CAPTURE(face);
    CHECK(read_obj_text(points + face).faces == std::vector<std::vector<int>>{{1, 2, 3}});
  }
  CHECK(read_obj_text("f 2 3 4\n" + points).faces == std::vector<std::vector<int>>{{1, 2, 3}});
}

TEST_CASE("OBJ: damage is named with its line") {
  CHECK_THROWS_WITH(read_obj_text("v 0 0\n"), "a.obj: line 1: a coordinate is missing");
  CHECK_THROWS_WITH(read_obj_text("v 0 0 0\nf 1 1\n"),
                    "a.obj: line 2: face has 2 vertices: at least 3 are needed");
  CHECK_THROWS_WITH(read_obj_text("v 0 0 0\nf 1 1 2\n"), "a.obj: line 2: face names vertex 2 of 1");
  CHECK_THROWS_WITH(read_obj_text("v 0 0 0\nf 1 1 -2\n"),
                    "a.obj: line 2: face names vertex -2 of 1");
  CHECK_THROWS_WITH(read_obj_text("\n\x01\x02\n"),
                    "a.obj: line 2: unknown OBJ statement '?"
                    "?'");
}
