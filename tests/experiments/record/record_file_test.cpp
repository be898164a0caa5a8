#include "experiments/record/record_file.hpp"

#include <cmath>

#include "platform/hdf5_file.hpp"
#include "tests/support/hdf5_attribute.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a frame is a row of numbers that comes back to the last bit") {
  const MotionState state = sample_state(sample_system(), 17);
  const size_t bodies = state.pose.size();
  std::vector<double> row;
  pack_pose_row(state, row);
  REQUIRE(row.size() == pose_row_size(bodies));
  const PoseFrame frame = unpack_pose_row(row);
  CHECK(frame.step == 17);
  CHECK(same_bits(frame.time, state.time));
  CHECK(same_bits(frame.pose, state.pose));
  CHECK(same_bits(frame.velocity, state.velocity));
  CHECK(same_bits(frame.spin, state.spin));
  CHECK(row[2] == state.pose[0].position.x());
  CHECK(row[2 + 3 * bodies] == state.pose[0].rotation.w());
}

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

TEST_CASE("columns that an older record lacks are not known, and the others are read") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "record.h5";
  Hdf5Writer file(path, Hdf5Storage::compressed);
  file.add_group("steps");
  file.add("steps/time", std::vector<double>{0.5, 1.0});
  file.add("steps/wall_x", std::vector<double>{2.0, 3.0});
  file.commit();
  const std::vector<StepRecord> steps = read_record_steps(path);
  REQUIRE(steps.size() == 2);
  CHECK(steps[1].wall_x == 3.0);
  CHECK(std::isnan(steps[1].solved));
  CHECK(std::isnan(steps[0].energy_gained));
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
