#include "experiments/record/record_file.hpp"

#include "platform/hdf5_file.hpp"
#include "tests/support/hdf5_attribute.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("record.h5 explains itself: units, bodies, shapes, scene and manifest") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record(recorder, system, 1, 10);
  const std::string scene(100000, 's'),
      manifest = "{\"µ\": 1}";  // longer than a compact attribute may be
  recorder.finish(scene, manifest);
  const fs::path path = folder.path() / "record.h5";
  const Hdf5Reader file(path);
  CHECK(hdf5_attribute(path, "/", "scene") == scene);
  CHECK(hdf5_attribute(path, "/", "manifest") == manifest);
  CHECK(hdf5_attribute(path, "/", "bits_generation") == std::to_string(bits_generation));
  for (const StepColumn& column : step_columns()) {
    const std::string name = std::string("steps/") + column.name;
    CHECK(hdf5_attribute(path, name, "unit") == column.unit);
    CHECK(hdf5_attribute(path, name, "description") == column.description);
  }
  CHECK(file.shape("poses/position") == Hdf5Shape{3, 9, 3});
  CHECK(file.shape("poses/rotation") == Hdf5Shape{3, 9, 4});
  CHECK(file.read_doubles("poses/step") == std::vector<double>{0, 5, 10});
  CHECK(hdf5_attribute(path, "poses/spin", "unit") == "rad/s");
  const auto names = file.read_texts("bodies/name");
  CHECK((names.size() == 9 && names[1] == "grain 1" && names[6] == "x_max"));
  CHECK(file.read_doubles("bodies/shape") == std::vector<double>{0, 1, 1, -1, -1, -1, -1, -1, -1});
  CHECK(file.read_doubles("bodies/mass")[2] == system.bodies[2].mass);
  CHECK(file.read_doubles("bodies/volume")[0] == system.bodies[0].volume);
  CHECK(file.read_doubles("bodies/inertia")[4] == system.bodies[1].inertia.y());
  CHECK(file.read_doubles("bodies/wall_normal")[3 * 6] == -1.0);
  const auto vertices = file.read_doubles("shapes/vertices"),
             triangles = file.read_doubles("shapes/triangles");
  const auto vertex_begin = file.read_doubles("shapes/vertex_begin"),
             triangle_begin = file.read_doubles("shapes/triangle_begin");
  REQUIRE((vertex_begin.size() == 3 && triangle_begin.size() == 3));
  REQUIRE(file.shape("shapes/vertices") == Hdf5Shape{static_cast<size_t>(vertex_begin[2]), 3});
  REQUIRE(file.shape("shapes/triangles") == Hdf5Shape{static_cast<size_t>(triangle_begin[2]), 3});
  for (int k = 0; k < 2; ++k) {
    CHECK(vertex_begin[k + 1] - vertex_begin[k] == system.shapes[k]->vertex_count());
    // the volume by the divergence theorem: vertices, triangles and their orientation all have to
    // be right
    double volume = 0.0;
    for (size_t t = 3 * static_cast<size_t>(triangle_begin[k]);
         t < 3 * static_cast<size_t>(triangle_begin[k + 1]); t += 3) {
      const auto vertex = [&](size_t i) {
        return Vec3(vertices.data() + 3 * static_cast<size_t>(vertex_begin[k] + triangles[t + i]));
      };
      volume += vertex(0).dot(vertex(1).cross(vertex(2))) / 6.0;
    }
    CHECK(volume == Approx(system.bodies[k].volume).epsilon(1e-12));
  }
}

TEST_CASE("a broken record.h5 is an error that names it") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const fs::path file = folder.path() / "record.h5";
  {
    Recorder recorder(folder.path(), system, 0);
    record(recorder, system, 1, 300);
    recorder.finish("", "");
  }
  const std::string whole = file_bytes(file);
  for (size_t part = 0; part < 40; ++part) {
    put_bytes(file, std::string_view(whole).substr(0, whole.size() * part / 40));
    CHECK_THAT(run_error([&] { read_steps(folder.path()); }), Contains(file.string()));
    CHECK_THAT(run_error([&] { read_poses(folder.path()); }), Contains(file.string()));
  }
  put_bytes(file, whole);
  check_record(folder.path(), system, 300);
}

TEST_CASE("bodies, walls and shapes come back from the record with their bits") {
  OpenRecord open(5);
  open.recorder.finish("", "");
  const MechanicalSystem& system = open.system;
  const MechanicalSystem read = read_record_system(open.path() / "record.h5");
  CHECK(read.grain_count == system.grain_count);
  REQUIRE(read.bodies.size() == system.bodies.size());
  REQUIRE(read.shapes.size() == system.shapes.size());
  for (size_t b = 0; b < read.bodies.size(); ++b) {
    const RigidBody &body = read.bodies[b], &expected = system.bodies[b];
    CHECK(body.name == expected.name);
    CHECK(same_bits(body.mass, expected.mass));
    CHECK(same_bits(body.volume, expected.volume));
    CHECK(same_bits(body.inertia, expected.inertia));
    REQUIRE(body.is_wall() == expected.is_wall());
    if (body.is_wall()) {
      CHECK(same_bits(body.shape.plane.normal, expected.shape.plane.normal));
      continue;
    }
    const Polyhedron &shape = *body.shape.polyhedron, &known = *expected.shape.polyhedron;
    REQUIRE(shape.vertex_count() == known.vertex_count());
    for (int v = 0; v < shape.vertex_count(); ++v)
      CHECK(same_bits(shape.vertex(v), known.vertex(v)));
    CHECK(shape.face_count() == known.face_count());
  }
  CHECK(read.bodies[1].shape.polyhedron == read.bodies[2].shape.polyhedron);
}

TEST_CASE("a record whose datasets do not fit together is refused") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "record.h5";
  Hdf5Writer writer(file, Hdf5Storage::plain);
  writer.add_group("bodies");
  writer.add("bodies/name", std::vector<std::string>{"a", "b"});
  for (const char* name : {"mass", "volume"})
    writer.add(std::string("bodies/") + name, std::vector<double>{1.0});
  for (const char* name : {"inertia", "wall_normal"})
    writer.add(std::string("bodies/") + name, std::vector<double>(6, 1.0));
  writer.add("bodies/shape", std::vector<std::int32_t>{0, 0});
  writer.commit();
  CHECK_THAT(run_error([&] { read_record_system(file); }), Contains("/bodies do not fit together"));
  CHECK_THAT(run_error([&] { read_record_system(folder.path() / "none.h5"); }),
             Contains("no such file"));
}

TEST_CASE("a log of other bodies is found out") {
  const TemporaryFolder folder;
  MechanicalSystem system = sample_system();
  require_same_bodies(folder.path(), system);  // nothing to compare with
  { Recorder recorder(folder.path(), system, 0); }
  require_same_bodies(folder.path(), system);
  system.bodies[0].mass *= 2.0;
  CHECK_THAT(run_error([&] { require_same_bodies(folder.path(), system); }),
             Contains("belongs to another system of bodies"));
}
