#include <cmath>
#include <cstring>

#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/shape/mesh_test_files.hpp"
#include "tests/support/mesh_writer.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("every broken mesh is one line that names the file, the line and the defect") {
  struct Broken {
    std::string name, content, place, defect;
  };
  const std::string box = [] {
    const TemporaryFolder folder;
    write_mesh(folder.path() / "box.stl", make_box({1, 2, 3}));
    return load(folder.path() / "box.stl");
  }();
  const std::string binary = binary_stl(make_box({1, 2, 3}));
  std::string binary_nan = binary;
  const float nan = std::nanf("");
  std::memcpy(binary_nan.data() + 84 + 50 + 12, &nan, 4);
  std::string binary_open = binary.substr(0, binary.size() - 50);
  binary_open[80] = 11;
  std::string inside_out = kCube;
  for (const auto& [from, to] : {std::pair("1 5 7 3", "3 7 5 1"),
                                 {"2 4 8 6", "6 8 4 2"},
                                 {"1 2 6 5", "5 6 2 1"},
                                 {"3 7 8 4", "4 8 7 3"},
                                 {"1 3 4 2", "2 4 3 1"},
                                 {"5 6 8 7", "7 8 6 5"}})
    inside_out = with(inside_out, from, to);

  const std::vector<Broken> table = {
      {"empty.obj", "", "", "the file is empty"},
      {"empty.stl", "", "", "the file is empty"},
      {"garbage.obj",
       "\x7f"
       "ELF\x02\x01 what is this",
       ": line 1", "unknown OBJ statement '?ELF"},
      {"garbage.stl", "what is this", "", "neither text STL (no 'solid') nor binary STL (12 bytes"},
      {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n", "", "the file has no faces"},
      {"comment.obj", "# nothing\n", "", "the file has no vertices"},
      {"unknown.obj", with(kCube, "f 3", "face 3"), ": line 12", "unknown OBJ statement 'face'"},
      {"word.obj", with(kCube, "v 1 0 0", "v 1 zero 0"), ": line 2", "'zero' is no number"},
      {"comma.obj", with(kCube, "v 1 0 0", "v 1,0 0 0"), ": line 2", "'1,0' is no number"},
      {"huge.obj", with(kCube, "v 1 0 0", "v 1e999 0 0"), ": line 2",
       "'1e999' is no number in range"},
      {"overflow.obj", with(kCube, "v 1 1 1", "v 1e200 1 1"), "", "too large"},
      {"short.obj", with(kCube, "v 1 0 0", "v 1 0"), ": line 2", "a coordinate is missing"},
      {"nan.obj", with(kCube, "v 1 1 0", "v 1 nan 0"), ": line 4",
       "coordinate 'nan' is not finite"},
      {"inf.obj", with(kCube, "v 1 1 0", "v 1 1 -inf"), ": line 4",
       "coordinate '-inf' is not finite"},
      {"index.obj", with(kCube, "2 4 8 6", "2 4 9 6"), ": line 10", "face names vertex 9 of 8"},
      {"zero.obj", with(kCube, "2 4 8 6", "2 4 0 6"), ": line 10", "'0' is no vertex index"},
      {"negative.obj", with(kCube, "2 4 8 6", "2 4 -9 6"), ": line 10",
       "face names vertex -9 of 8"},
      {"word_index.obj", with(kCube, "2 4 8 6", "2 4 x 6"), ": line 10", "'x' is no vertex index"},
      {"huge_index.obj", with(kCube, "2 4 8 6", "2 4 99999999999 6"), ": line 10",
       "is no vertex index"},
      {"line.obj", with(kCube, "2 4 8 6", "2 4"), ": line 10", "face has 2 vertices"},
      {"repeat.obj", with(kCube, "2 4 8 6", "2 4 4 6"), ": line 10",
       "face 1 passes through vertex 3 twice"},
      {"open.obj", with(kCube, "f 5 6 8 7\n", ""), ": line 11",
       "the mesh is open at edge 4-5: only face 2 has it"},
      {"manifold.obj", kCube + "f 5 6 8 7\n", ": line 15",
       "edge 4-5 is shared by 3 faces (non-manifold), the last of them face 6"},
      {"turned.obj", with(kCube, "5 6 8 7", "7 8 6 5"), ": line 14", "one of them is turned over"},
      {"inward.obj", inside_out, "", "all faces are turned inward"},
      {"unused.obj", with(kCube, "f 1 ", "v 3 3 3\nf 1 "), ": line 9",
       "vertex 8 belongs to no face"},
      {"dent.obj", with(kCube, "v 1 1 1", "v 0.6 0.6 0.6"), ": line 10", "face 1 is not flat"},
      {"flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 4 3 2\nf 1 3 4\nf 1 4 2\n", "",
       "the mesh is flat"},
      {"name.stl", with(box, "facet normal", "facette normal"), ": line 2",
       "expected 'facet' or 'endsolid', found 'facette'"},
      {"vertex.stl", with(box, "vertex -0.5", "vertex minus"), ": line 4", "'minus' is no number"},
      {"nan.stl", with(box, "vertex -0.5", "vertex nan"), ": line 4", "not finite"},
      {"four.stl", with(box, "endloop", "vertex 1 1 1\nendloop"), ": line 7",
       "expected 'endloop', found 'vertex'"},
      {"cut.stl", box.substr(0, box.rfind("outer")), ": line 79", "the file ends where 'outer'"},
      {"noend.stl", with(box, "endsolid ballast\n", ""), ": line 85",
       "the file ends where 'facet' or 'endsolid'"},
      {"after.stl", box + "and more", ": line 87", "expected 'solid', found 'and'"},
      {"none.stl", "solid nothing\nendsolid nothing\n", "", "the file has no vertices"},
      {"open.stl", box.substr(0, box.rfind("facet normal")) + "endsolid\n", ": line ",
       "the mesh is open"},
      {"twice.stl", box + box, ": line ", "is shared by 4 faces"},
      {"needle.stl", with(box, "vertex -0.5 -1 -1.5", "vertex -0.5 1 1.5"), ": line 2",
       "face 0 passes through vertex"},
      {"truncated.stl", binary.substr(0, binary.size() - 7), "",
       "12 triangles take 684 bytes, the file has 677"},
      {"longer.stl", binary + "x", "", "12 triangles take 684 bytes, the file has 685"},
      {"header.stl", binary.substr(0, 50), "", "neither text STL"},
      {"nan_binary.stl", binary_nan, "", "triangle 1 has a coordinate that is not finite"},
      {"open_binary.stl", binary_open, "", "the mesh is open"},
      {"grain.ply", kCube, "", "unknown suffix '.ply'"},
      {"grain", kCube, "", "unknown suffix ''"},
  };
  const TemporaryFolder folder;
  for (const Broken& b : table) {
    const fs::path file = folder.path() / b.name;
    save(file, b.content);
    const std::string said = complaint([&] { read_mesh(file); });
    CAPTURE(b.name, said);
    CHECK(said.starts_with(file.string() + b.place));
    CHECK(said.find(b.defect) != std::string::npos);
    CHECK(said.find('\n') == std::string::npos);
    CHECK(said.size() > file.string().size() + 10);
  }
  const fs::path missing = folder.path() / "missing.obj";
  CHECK(complaint([&] { read_mesh(missing); }) ==
        missing.string() + ": cannot open: No such file or directory");
  fs::create_directory(folder.path() / "folder.obj");
  CHECK(complaint([&] { read_mesh(folder.path() / "folder.obj"); }).find("Is a directory") !=
        std::string::npos);
}

TEST_CASE("mutilated files are read or refused, never worse") {
  const TemporaryFolder folder;
  Random random(9);
  const Polyhedron grain = make_grain({}, 1.0, 1).shape;
  write_mesh(folder.path() / "a.obj", grain);
  write_mesh(folder.path() / "a.stl", grain);
  const std::vector<std::pair<std::string, std::string>> sources = {
      {"b.obj", load(folder.path() / "a.obj")},
      {"b.stl", load(folder.path() / "a.stl")},
      {"b.stl", binary_stl(grain)}};
  int refused = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    auto [name, content] = sources[trial % 3];
    for (int change = 1 + random.below(4); change > 0; --change) {
      const size_t at = random.below(static_cast<int>(content.size()));
      switch (random.below(3)) {
        case 0:
          content[at] = static_cast<char>(random.below(256));
          break;
        case 1:
          content.erase(at, 1 + random.below(20));
          break;
        default:
          content.insert(at, content.substr(random.below(static_cast<int>(content.size())), 10));
      }
    }
    save(folder.path() / name, content);
    refused += complaint([&] { read_mesh(folder.path() / name); }) != "";
    complaint([&] { read_mesh_hull(folder.path() / name); });
  }
  CHECK(refused > 1000);
}
