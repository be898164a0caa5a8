#include "geometry/shape/mesh_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "geometry/shape/convex_hull.hpp"
#include "geometry/shape/grain_shapes.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/random_direction.hpp"
#include "tests/catch.hpp"
#include "tests/geometry/shape/mesh_test_files.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/uv_sphere.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Faces as lists of corner positions, each from its smallest corner on, sorted: independent of the
/// numbering.
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

}  // namespace

TEST_CASE("OBJ gives back the same polyhedron, bit for bit") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "grain.obj";
  for (int seed = 0; seed < 40; ++seed) {
    const Polyhedron p = seed == 0 ? make_box({0.1, 0.2, 0.3}) : make_grain({}, 0.0125, seed).shape;
    write_mesh(file, p);
    const Polyhedron q = read_mesh(file);
    REQUIRE(q.face_count() == p.face_count());
    CHECK(std::equal(p.vertices().begin(), p.vertices().end(), q.vertices().begin(),
                     q.vertices().end()));
    for (int f = 0; f < p.face_count(); ++f)
      CHECK(std::equal(p.face(f).begin(), p.face(f).end(), q.face(f).begin(), q.face(f).end()));
  }
}

TEST_CASE("STL gives back the same solid, bit for bit") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "grain.STL";
  for (int seed = 0; seed < 40; ++seed) {
    const Polyhedron p = seed == 0 ? make_box({0.1, 0.2, 0.3}) : make_grain({}, 0.0125, seed).shape;
    write_mesh(file, p);
    CHECK(solid(read_mesh(file)) == solid(p));
  }
}

TEST_CASE("binary STL in single precision, also when its header says solid") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "grain.stl";
  Random random(1);
  for (int seed = 0; seed < 40; ++seed) {
    const Polyhedron grain = make_grain({}, 0.0125, seed).shape;
    std::vector<Vec3> turned;
    const Polyhedron box = make_box({0.1, 0.2, 0.3});
    const Quat turn = random_rotation(random);
    for (const Vec3& x : (seed % 2 ? grain : box).vertices()) turned.push_back(turn * x);
    const Polyhedron p = convex_hull(turned);
    save(file, binary_stl(p, seed % 3 ? "solid made by a scanner" : ""));
    const Polyhedron q = read_mesh(file);
    CHECK(q.vertex_count() == p.vertex_count());
    CHECK(mass_properties(q).volume == Approx(mass_properties(p).volume).epsilon(1e-6));
  }
}

TEST_CASE("OBJ as other programs write it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "cube.obj";
  const std::set<std::vector<std::array<double, 3>>> cube = [&] {
    save(file, kCube);
    return solid(read_mesh(file));
  }();
  REQUIRE(cube.size() == 6);
  std::string text = kCube;
  SECTION("comments, groups, materials, blank lines") {
    text = "# made by\nmtllib a.mtl\no cube\n\ng side\nusemtl stone\ns off\n" +
           with(text, "f 1 5 7 3", "f 1 5 7 3 # left");
  }
  SECTION("texture and normal indices") {
    text = "vt 0 0\nvn 0 0 1\n" +
           with(with(with(text, "1 5 7 3", "1/1 5/1 7/1 3/1"), "2 4 8 6", "2//1 4//1 8//1 6//1"),
                "3 7 8 4", "3/1/1 7/1/1 8/1/1 4/1/1");
  }
  SECTION("negative indices") {
    text = with(with(text, "1 5 7 3", "-8 -4 -2 -6"), "5 6 8 7", "5 -3 8 -2");
  }
  SECTION("DOS line ends and tabs") {
    std::string dos;
    for (const char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
    text = with(dos, "v 1 0 0", "v\t1  0\t0 ");
  }
  SECTION("exponents, signs, weights, colours") {
    text = with(with(text, "v 1 0 0", "v +1.0e0 -0 0.0 1.0"), "v 0 1 0", "v 0 10E-1 0 0.5 0.5 0.5");
  }
  SECTION("faces before vertices") {
    text = text.substr(text.find('f')) + text.substr(0, text.find('f'));
  }
  SECTION("no newline at the end") { text.pop_back(); }
  SECTION("triangles: coplanar neighbours become one face again") {
    text = with(text, "f 1 5 7 3", "f 1 5 7\nf 1 7 3");
  }
  save(file, text);
  CHECK(solid(read_mesh(file)) == cube);
}

TEST_CASE("text STL as other programs write it") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "box.stl";
  const Polyhedron box = make_box({1, 2, 3});
  write_mesh(file, box);
  std::string text = load(file);
  SECTION("capitals") {
    for (char& c : text)
      if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  SECTION("a name of several words") {
    text = with(text, "solid ballast", "  solid facet of a crusher");
  }
  SECTION("no name") {
    text = with(with(text, "solid ballast", "solid"), "endsolid ballast", "endsolid");
  }
  SECTION("normals that are no numbers") {
    text = with(text, "normal -1 0 0", "normal nan -nan(ind) x");
  }
  SECTION("corners that agree to seven digits only") {
    text = with(text, "vertex -0.5 -1 -1.5", "vertex -0.5 -1 -1.4999999");
  }
  save(file, text);
  const Polyhedron q = read_mesh(file);
  CHECK(q.vertex_count() == 8);
  CHECK(mass_properties(q).volume == Approx(6.0).epsilon(1e-6));
}

TEST_CASE("the scale multiplies coordinates") {
  const TemporaryFolder folder;
  save(folder.path() / "cube.obj", kCube);
  CHECK(mass_properties(read_mesh(folder.path() / "cube.obj", 0.001)).volume == Approx(1e-9));
  CHECK(mass_properties(read_mesh_hull(folder.path() / "cube.obj", 2.0)).volume == Approx(8.0));
  for (const double scale : {0.0, -1.0, std::nan("")})
    CHECK(complaint([&] {
            read_mesh(folder.path() / "cube.obj", scale);
          }).find("scale must be positive") != std::string::npos);
}

TEST_CASE("scanned grains: the hull of whatever the vertices are") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "scan.obj";
  save(file,
       with(kCube, "f 1 5 7 3\n", "") + "v 0.5 0.5 0.5\n");  // open, with a stray vertex inside
  CHECK(complaint([&] { read_mesh(file); }) != "");
  CHECK(read_mesh_hull(file).face_count() == 6);
  save(file, kCube.substr(0, kCube.find('f')));  // a point cloud
  CHECK(read_mesh_hull(file).face_count() == 6);
  save(file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n");
  const std::string said = complaint([&] { read_mesh_hull(file); });
  CHECK(said == file.string() + ": no convex hull: all points lie in one plane");
}

TEST_CASE("a turned box in binary STL, which is single precision, has six faces") {
  const TemporaryFolder folder;
  Random random(8);
  for (int trial = 0; trial < 10; ++trial) {
    const Quat turn = random_rotation(random);
    const Polyhedron box = make_box(Vec3(1, 2, 3));
    std::vector<Vec3> corners;
    std::vector<std::vector<int>> faces;
    for (const Vec3& v : box.vertices()) corners.push_back(turn * v);
    for (int f = 0; f < 6; ++f) faces.emplace_back(box.face(f).begin(), box.face(f).end());
    const fs::path file = folder.path() / "box.stl";
    save(file, binary_stl(Polyhedron(corners, faces)));
    for (const Polyhedron& read : {read_mesh(file), read_mesh_hull(file)}) {
      CHECK(read.face_count() == 6);
      CHECK(read.vertex_count() == 8);
    }
  }
}

TEST_CASE("a smooth sphere in single precision, whose thin triangles know their planes badly") {
  const TemporaryFolder folder;
  Random random(9);
  // Near the origin, and so far that four digits of it are left.
  for (const double away : {0.0, 40.0}) {
    INFO(away);
    const UvSphere sphere = make_uv_sphere(120, 200);
    const Quat turn = random_rotation(random);
    std::vector<Vec3> corners;
    for (const Vec3& v : sphere.vertices)
      corners.push_back(turn * v + away * Vec3(0.6, -0.48, 0.64));
    const fs::path file = folder.path() / "sphere.stl";
    save(file, binary_stl(Polyhedron(corners, sphere.faces)));
    const Polyhedron read = read_mesh(file);
    CHECK(read.vertex_count() > 0.9 * static_cast<double>(corners.size()));
    CHECK(mass_properties(read).volume ==
          Approx(mass_properties(Polyhedron(corners, sphere.faces)).volume).epsilon(1e-5));
  }
}

TEST_CASE("a pipe or a device is no mesh, and is not waited for") {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe.obj", zero = folder.path() / "zero.stl";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", zero);
  CHECK_THAT(complaint([&] { read_mesh(pipe); }), Catch::Contains("it is a pipe"));
  CHECK_THAT(complaint([&] { read_mesh(zero); }), Catch::Contains("it is a device"));
}

TEST_CASE("a large mesh is read in a time that grows as its size") {
  // 120000 triangles on six flat sides: each face against each vertex would be 7e9 looks.
  const TemporaryFolder folder;
  const int n = 100;
  std::string text;
  const auto number = [&](int i, int j, int k) {
    text += "v " + std::to_string(i) + ' ' + std::to_string(j) + ' ' + std::to_string(k) + '\n';
  };
  std::map<std::tuple<int, int, int>, int> index;
  std::string faces;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [found, is_new] =
        index.emplace(std::tuple(p[0], p[1], p[2]), static_cast<int>(index.size()) + 1);
    if (is_new) number(p[0], p[1], p[2]);
    return std::to_string(found->second);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, n})
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          std::vector<std::string> loop;
          for (const auto& [a, b] :
               {std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1)}) {
            std::array<int, 3> p{};
            p[static_cast<size_t>(axis)] = side;
            p[static_cast<size_t>((axis + 1) % 3)] = i + a;
            p[static_cast<size_t>((axis + 2) % 3)] = j + b;
            loop.push_back(vertex(p));
          }
          if (side == 0) std::reverse(loop.begin(), loop.end());
          faces += "f " + loop[0] + ' ' + loop[1] + ' ' + loop[2] + "\nf " + loop[0] + ' ' +
                   loop[2] + ' ' + loop[3] + '\n';
        }
  const fs::path file = folder.path() / "cube.obj";
  save(file, text + faces);
  const Polyhedron cube = read_mesh(file);
  CHECK(cube.face_count() == 6);
  CHECK(cube.vertex_count() == 8);
}
