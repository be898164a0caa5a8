#include "problems/scene/scene_key.hpp"

#include "geometry/shape/mesh_file.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/mesh_writer.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// The polyhedron with its vertices listed from the last to the first.
Polyhedron renumbered(const Polyhedron& mesh) {
  std::vector<Vec3> vertices(mesh.vertices().rbegin(), mesh.vertices().rend());
  std::vector<std::vector<int>> faces;
  for (int f = 0; f < mesh.face_count(); ++f) {
    faces.emplace_back();
    for (const int v : mesh.face(f)) faces.back().push_back(mesh.vertex_count() - 1 - v);
  }
  return Polyhedron(std::move(vertices), faces);
}

}  // namespace

TEST_CASE("a mesh's key is that of its vertices and faces, in their order") {
  const Polyhedron box = make_box(Vec3(1, 2, 3));
  CHECK(mesh_key(box) == mesh_key(make_box(Vec3(1, 2, 3))));
  CHECK(mesh_key(box) != mesh_key(make_box(Vec3(1, 2, std::nextafter(3.0, 4.0)))));
  CHECK(mesh_key(box) != mesh_key(renumbered(box)));  // other bits come of it
}

TEST_CASE("without meshes a scene's key is that of its resolved text, as it always was") {
  for (const auto& [name, title] : list_scenes()) {
    const ResolvedScene resolved = resolve_scene(find_scene(name));
    CHECK(resolved.key == content_key(resolved.text));
    CHECK(resolved.text == resolved_scene_text(find_scene(name)));
  }
}

TEST_CASE("a key that came later, given as it is by default, leaves a scene's key as it was") {
  const auto key = [](const std::vector<std::string>& overrides) {
    return resolve_scene(find_scene("incline"), overrides).key;
  };
  const std::vector<std::string> without{"record.forces=false"}, with{"record.forces=true"};
  CHECK(key(without) == key({}));
  CHECK(key(with) != key({}));
}

TEST_CASE("an edited mesh makes another scene; its time stamp and comments do not") {
  const TemporaryFolder folder;
  const fs::path mesh = folder.path() / "stone.obj";
  const auto body = folder.write("body.toml",
                                 "[[body]]\nshape = \"mesh\"\nfile = \"stone.obj\"\nmass = 1\n"
                                 "[[wall]]\nnormal = [0, 0, 1]\n");
  const std::string base = "grains.meshes=[\"" + mesh.string() + "\"]";
  const std::vector<std::string> grains{base, "grains.count=3"};
  const auto keys = [&] {
    return std::pair(resolve_scene(body).key,
                     resolve_scene(find_scene("vibrated_box_small"), grains).key);
  };
  write_mesh(mesh, make_box(Vec3(1, 2, 3)));
  const auto before = keys();
  fs::last_write_time(mesh, fs::last_write_time(mesh) - std::chrono::hours(1));
  CHECK(keys() == before);
  std::ofstream(mesh, std::ios::app) << "# a note\n";
  CHECK(keys() == before);
  write_mesh(mesh, make_box(Vec3(1, 2, 3.0001)));
  CHECK(keys().first != before.first);
  CHECK(keys().second != before.second);
}
