#include "geometry/shape/mesh_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <set>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/pose.hpp"
#include "platform/random.hpp"
#include "platform/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// The unit sphere as most programs make it: rings of triangles between two poles.
struct UvSphere {
  std::vector<Vec3> vertices;           ///< the poles are the last
  std::vector<std::vector<int>> faces;  ///< triangles, outward
};

/// Makes 2 (rings - 1) columns triangles, two for each quadrilateral of a ring, which is plane.
UvSphere make_uv_sphere(int rings, int columns) {
  UvSphere sphere;
  for (int i = 1; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      const double polar = i * std::numbers::pi / rings,
                   around = j * 2.0 * std::numbers::pi / columns;
      sphere.vertices.emplace_back(std::sin(polar) * std::cos(around),
                                   std::sin(polar) * std::sin(around), std::cos(polar));
    }
  const int north = static_cast<int>(sphere.vertices.size()), south = north + 1;
  sphere.vertices.insert(sphere.vertices.end(), {Vec3::UnitZ(), -Vec3::UnitZ()});
  const auto at = [&](int i, int j) { return i * columns + j % columns; };
  for (int j = 0; j < columns; ++j) {
    sphere.faces.push_back({north, at(0, j), at(0, j + 1)});
    for (int i = 0; i + 2 < rings; ++i) {
      sphere.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      sphere.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
    sphere.faces.push_back({south, at(rings - 2, j + 1), at(rings - 2, j)});
  }
  return sphere;
}

/// The faces as lists of corner positions, each from its smallest corner on, sorted: this does not
/// depend on the numbering.
std::set<std::vector<std::array<double, 3>>> solid(const Polyhedron& p) {
  std::set<std::vector<std::array<double, 3>>> faces;
  for (int f = 0; f < p.face_count(); ++f) {
    std::vector<std::array<double, 3>> corners;
    for (const int v : p.face(f))
      corners.push_back({p.vertex(v).x(), p.vertex(v).y(), p.vertex(v).z()});
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    faces.insert(corners);
  }
  return faces;
}

template <class Number>
void append_bytes(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

/// A binary STL in single precision, with the normals zero, as many writers leave them.
std::string binary_stl(const Polyhedron& p, const std::string& header = "binary") {
  std::string triangles;
  std::uint32_t count = 0;
  for (int f = 0; f < p.face_count(); ++f) {
    const auto loop = p.face(f);
    for (size_t k = 2; k < loop.size(); ++k, ++count) {
      triangles.append(12, '\0');
      for (const int v : {loop[0], loop[k - 1], loop[k]})
        for (const double x : p.vertex(v)) append_bytes(triangles, static_cast<float>(x));
      triangles.append(2, '\0');
    }
  }
  std::string bytes = header + std::string(80 - header.size(), '\0');
  append_bytes(bytes, count);
  return bytes + triangles;
}

const std::string cube_obj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";

/// `text`, with the first occurrence of `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("OBJ gives back the same polyhedron, STL the same solid, bit for bit") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "grain.obj", stl = folder.path() / "grain.STL";
  for (int seed = 0; seed < 40; ++seed) {
    const Polyhedron p = seed == 0 ? make_box({0.1, 0.2, 0.3}) : make_grain({}, 0.0125, seed).shape;
    write_mesh(stl, p);
    CHECK(solid(read_mesh(stl)) == solid(p));
    write_mesh(file, p);
    const Polyhedron q = read_mesh(file);
    REQUIRE(q.face_count() == p.face_count());
    CHECK(std::equal(p.vertices().begin(), p.vertices().end(), q.vertices().begin(),
                     q.vertices().end()));
    for (int f = 0; f < p.face_count(); ++f)
      CHECK(std::equal(p.face(f).begin(), p.face(f).end(), q.face(f).begin(), q.face(f).end()));
  }
}

TEST_CASE("binary STL in single precision, also when its header says solid") {
  const TemporaryFolder folder;
  Random random(1);
  for (int seed = 0; seed < 40; ++seed) {
    const Polyhedron grain = make_grain({}, 0.0125, seed).shape;
    std::vector<Vec3> turned;
    const Polyhedron box = make_box({0.1, 0.2, 0.3});
    const Quat turn = random_rotation(random);
    for (const Vec3& x : (seed % 2 ? grain : box).vertices()) turned.push_back(turn * x);
    const Polyhedron p = convex_hull(turned);
    const fs::path file =
        folder.write("grain.stl", binary_stl(p, seed % 3 ? "solid made by a scanner" : ""));
    for (const Polyhedron& q : {read_mesh(file), read_mesh_hull(file)}) {
      CHECK(q.vertex_count() == p.vertex_count());
      if (seed % 2 == 0) CHECK(q.face_count() == 6);  // a box, though rounding turns its sides
      CHECK(mass_properties(q).volume == Approx(mass_properties(p).volume).epsilon(1e-6));
    }
  }
}

TEST_CASE("OBJ as other programs write it") {
  const TemporaryFolder folder;
  const auto cube = solid(read_mesh(folder.write("cube.obj", cube_obj)));
  REQUIRE(cube.size() == 6);
  const std::string& text = cube_obj;
  std::string dos;
  for (const char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& written : {
           // Comments, groups, materials, blank lines.
           "# made by\nmtllib a.mtl\no cube\n\ng side\nusemtl stone\ns off\n" +
               with(text, "f 1 5 7 3", "f 1 5 7 3 # left"),
           // Texture and normal indices.
           "vt 0 0\nvn 0 0 1\n" + with(with(with(text, "1 5 7 3", "1/1 5/1 7/1 3/1"), "2 4 8 6",
                                            "2//1 4//1 8//1 6//1"),
                                       "3 7 8 4", "3/1/1 7/1/1 8/1/1 4/1/1"),
           // Negative indices.
           with(with(text, "1 5 7 3", "-8 -4 -2 -6"), "5 6 8 7", "5 -3 8 -2"),
           // DOS line ends and tabs.
           with(dos, "v 1 0 0", "v\t1  0\t0 "),
           // Exponents, signs, weights, colours.
           with(with(text, "v 1 0 0", "v +1.0e0 -0 0.0 1.0"), "v 0 1 0", "v 0 10E-1 0 0.5 0.5 0.5"),
           // Faces before vertices.
           text.substr(text.find('f')) + text.substr(0, text.find('f')),
           // No newline at the end.
           text.substr(0, text.size() - 1),
           // Triangles: coplanar neighbours become one face again.
           with(text, "f 1 5 7 3", "f 1 5 7\nf 1 7 3"),
       }) {
    CAPTURE(written);
    CHECK(solid(read_mesh(folder.write("cube.obj", written))) == cube);
  }
}

TEST_CASE("text STL as other programs write it") {
  const TemporaryFolder folder;
  const std::string text = stl_text(make_box({1, 2, 3}));
  std::string capitals = text;
  for (char& c : capitals)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  for (const std::string& written : {
           capitals,
           // A name of several words, and no name.
           with(text, "solid ballast", "  solid facet of a crusher"),
           with(with(text, "solid ballast", "solid"), "endsolid ballast", "endsolid"),
           // Normals that are not numbers, and corners that agree only to seven digits.
           with(text, "normal -1 0 0", "normal nan -nan(ind) x"),
           with(text, "vertex -0.5 -1 -1.5", "vertex -0.5 -1 -1.4999999"),
       }) {
    CAPTURE(written);
    const Polyhedron q = read_mesh(folder.write("box.stl", written));
    CHECK(q.vertex_count() == 8);
    CHECK(mass_properties(q).volume == Approx(6.0).epsilon(1e-6));
  }
}

TEST_CASE("the scale multiplies coordinates") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("cube.obj", cube_obj);
  CHECK(mass_properties(read_mesh(file, 0.001)).volume == Approx(1e-9));
  CHECK(mass_properties(read_mesh_hull(file, 2.0)).volume == Approx(8.0));
  for (const double scale : {0.0, -1.0, std::nan("")})
    CHECK_THROWS_WITH(read_mesh(file, scale), Catch::Contains("scale must be positive"));
}

TEST_CASE("scanned grains: the hull of whatever the vertices are") {
  const TemporaryFolder folder;
  for (const std::string& text :
       {with(cube_obj, "f 1 5 7 3\n", "") + "v 0.5 0.5 0.5\n",  // open, with a stray vertex inside
        cube_obj.substr(0, cube_obj.find('f'))}) {              // a point cloud
    const fs::path file = folder.write("scan.obj", text);
    CHECK_THROWS_AS(read_mesh(file), MeshFileError);
    CHECK(read_mesh_hull(file).face_count() == 6);
  }
  const fs::path flat = folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n");
  CHECK_THROWS_WITH(read_mesh_hull(flat),
                    flat.string() + ": no convex hull: all points lie in one plane");
}

TEST_CASE("a smooth sphere in single precision, whose thin triangles know their planes badly") {
  const TemporaryFolder folder;
  Random random(9);
  // Near the origin, and so far away that only four digits of the sphere are left.
  for (const double away : {0.0, 40.0}) {
    INFO(away);
    const UvSphere sphere = make_uv_sphere(40, 60);
    const Quat turn = random_rotation(random);
    std::vector<Vec3> corners;
    for (const Vec3& v : sphere.vertices)
      corners.push_back(turn * v + away * Vec3(0.6, -0.48, 0.64));
    const Polyhedron given(corners, sphere.faces),
        read = read_mesh(folder.write("sphere.stl", binary_stl(given)));
    CHECK(read.vertex_count() > 0.9 * static_cast<double>(corners.size()));
    CHECK(mass_properties(read).volume == Approx(mass_properties(given).volume).epsilon(1e-5));
  }
}

TEST_CASE("a pipe or a device is no mesh, and is not waited for") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe.obj", zero = folder.path() / "zero.stl";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", zero);
  CHECK_THROWS_WITH(read_mesh(pipe), Catch::Contains("it is a pipe"));
  CHECK_THROWS_WITH(read_mesh(zero), Catch::Contains("it is a device"));
}

TEST_CASE("a mesh of too many vertices is refused, unless its hull has few") {
  const TemporaryFolder folder;
  const UvSphere sphere = make_uv_sphere(100, 102);
  const fs::path file =
      folder.write("sphere.obj", obj_text(Polyhedron(sphere.vertices, sphere.faces)));
  const std::string said = complaint_about(file, [&] { read_mesh(file); });
  CHECK_THAT(said, Catch::StartsWith("has 10100 vertices, at most 10000"));
  CHECK(complaint_about(file, [&] { read_mesh_hull(file); }) == said);
  std::string cloud = cube_obj.substr(0, cube_obj.find('f'));
  for (int k = 0; k < 20000; ++k) cloud += printed("v 0.5 %g 0.5\n", 1e-5 * k);
  CHECK(read_mesh_hull(folder.write("cloud.obj", cloud)).vertex_count() == 8);
}

TEST_CASE("every broken mesh is one line that names the file, the line and the defect") {
  struct Broken {
    std::string name, content, place, defect;
  };
  const std::string box = stl_text(make_box({1, 2, 3}));
  const std::string binary = binary_stl(make_box({1, 2, 3}));
  std::string binary_nan = binary;
  const float nan = std::nanf("");
  std::memcpy(binary_nan.data() + 84 + 50 + 12, &nan, 4);
  std::string binary_open = binary.substr(0, binary.size() - 50);
  binary_open[80] = 11;
  std::string inside_out = cube_obj;
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
      {"unknown.obj", with(cube_obj, "f 3", "face 3"), ": line 12", "unknown OBJ statement 'face'"},
      {"word.obj", with(cube_obj, "v 1 0 0", "v 1 zero 0"), ": line 2", "'zero' is no number"},
      {"comma.obj", with(cube_obj, "v 1 0 0", "v 1,0 0 0"), ": line 2", "'1,0' is no number"},
      {"huge.obj", with(cube_obj, "v 1 0 0", "v 1e999 0 0"), ": line 2",
       "'1e999' is no number in range"},
      {"overflow.obj", with(cube_obj, "v 1 1 1", "v 1e200 1 1"), "", "too large"},
      {"short.obj", with(cube_obj, "v 1 0 0", "v 1 0"), ": line 2", "a coordinate is missing"},
      {"nan.obj", with(cube_obj, "v 1 1 0", "v 1 nan 0"), ": line 4",
       "coordinate 'nan' is not finite"},
      {"inf.obj", with(cube_obj, "v 1 1 0", "v 1 1 -inf"), ": line 4",
       "coordinate '-inf' is not finite"},
      {"index.obj", with(cube_obj, "2 4 8 6", "2 4 9 6"), ": line 10", "face names vertex 9 of 8"},
      {"zero.obj", with(cube_obj, "2 4 8 6", "2 4 0 6"), ": line 10", "'0' is no vertex index"},
      {"negative.obj", with(cube_obj, "2 4 8 6", "2 4 -9 6"), ": line 10",
       "face names vertex -9 of 8"},
      {"word_index.obj", with(cube_obj, "2 4 8 6", "2 4 x 6"), ": line 10",
       "'x' is no vertex index"},
      {"huge_index.obj", with(cube_obj, "2 4 8 6", "2 4 99999999999 6"), ": line 10",
       "is no vertex index"},
      {"line.obj", with(cube_obj, "2 4 8 6", "2 4"), ": line 10", "face has 2 vertices"},
      {"repeat.obj", with(cube_obj, "2 4 8 6", "2 4 4 6"), ": line 10",
       "face 1 passes through vertex 3 twice"},
      {"open.obj", with(cube_obj, "f 5 6 8 7\n", ""), ": line 11",
       "the mesh is open at edge 4-5: only face 2 has it"},
      {"manifold.obj", cube_obj + "f 5 6 8 7\n", ": line 15",
       "edge 4-5 is shared by 3 faces (non-manifold), the last of them face 6"},
      {"turned.obj", with(cube_obj, "5 6 8 7", "7 8 6 5"), ": line 14",
       "one of them is turned over"},
      {"inward.obj", inside_out, "", "all faces are turned inward"},
      {"unused.obj", with(cube_obj, "f 1 ", "v 3 3 3\nf 1 "), ": line 9",
       "vertex 8 belongs to no face"},
      {"dent.obj", with(cube_obj, "v 1 1 1", "v 0.6 0.6 0.6"), ": line 10", "face 1 is not flat"},
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
      {"grain.ply", cube_obj, "", "unknown suffix '.ply'"},
      {"grain", cube_obj, "", "unknown suffix ''"},
  };
  const TemporaryFolder folder;
  for (const Broken& b : table) {
    const fs::path file = folder.write(b.name, b.content);
    const std::string said = complaint<MeshFileError>([&] { read_mesh(file); });
    CAPTURE(b.name);
    CHECK_THAT(said, Catch::StartsWith(file.string() + b.place) && Catch::Contains(b.defect));
    CHECK(said.find('\n') == std::string::npos);
  }
  const fs::path missing = folder.path() / "missing.obj", inside = folder.path() / "folder.obj";
  CHECK_THROWS_WITH(read_mesh(missing),
                    missing.string() + ": cannot open: No such file or directory");
  fs::create_directory(inside);
  CHECK_THROWS_WITH(read_mesh(inside), Catch::Contains("Is a directory"));
}

TEST_CASE("mutilated files are read or refused, never worse") {
  const TemporaryFolder folder;
  Random random(9);
  const Polyhedron grain = make_grain({}, 1.0, 1).shape;
  const std::vector<std::pair<std::string, std::string>> sources = {
      {"b.obj", obj_text(grain)}, {"b.stl", stl_text(grain)}, {"b.stl", binary_stl(grain)}};
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
    const fs::path file = folder.write(name, content);
    refused += complaint<MeshFileError>([&] { read_mesh(file); }) != "";
    complaint<MeshFileError>([&] { read_mesh_hull(file); });
  }
  CHECK(refused > 1000);
}
