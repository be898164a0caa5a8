#include "experiments/record/record_file.hpp"

#include <algorithm>

#include "platform/hdf5_file.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

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
