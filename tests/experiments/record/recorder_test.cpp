#include "experiments/record/recorder.hpp"

#include <cstdlib>

#include "platform/hdf5_reader.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("records come back to the last bit, from the logs and from record.h5") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record(recorder, system, 1, 23);
  recorder.flush();
  check_record(folder.path(), system, 23);
  recorder.finish("scene text", "{}");
  fs::remove_all(folder.path() / "log");
  check_record(folder.path(), system, 23);
  CHECK_FALSE(fs::exists(folder.path() / "record.h5.tmp"));
}

TEST_CASE("steps.csv has a line of names and then numbers that round trip") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record(recorder, system, 1, 4);
  recorder.finish("", "");
  std::istringstream lines(file_bytes(folder.path() / "steps.csv"));
  std::string line, names;
  for (const StepColumn& column : step_columns())
    names.append(names.empty() ? "" : ",").append(column.name);
  REQUIRE(std::getline(lines, line));
  CHECK(line == names);
  for (long step = 1; step <= 4; ++step) {
    REQUIRE(std::getline(lines, line));
    std::istringstream cells(line);
    std::string cell;
    for (const StepColumn& column : step_columns()) {
      REQUIRE(std::getline(cells, cell, ','));
      CHECK(same_bits(std::strtod(cell.c_str(), nullptr), sample_row(step).*column.value));
    }
    CHECK_FALSE(std::getline(cells, cell));
  }
  CHECK_FALSE(std::getline(lines, line));
}

TEST_CASE("record.h5 explains itself: units, bodies, shapes, scene and manifest") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record(recorder, system, 1, 10);
  const std::string scene(100000, 's'),
      manifest = "{\"µ\": 1}";  // longer than a compact attribute may be
  recorder.finish(scene, manifest);
  const Hdf5Reader file(folder.path() / "record.h5");
  CHECK(file.read_attribute("/", "scene") == scene);
  CHECK(file.read_attribute("/", "manifest") == manifest);
  for (const StepColumn& column : step_columns()) {
    const std::string name = std::string("steps/") + column.name;
    CHECK(file.read_attribute(name, "unit") == column.unit);
    CHECK(file.read_attribute(name, "description") == column.description);
  }
  CHECK(file.shape("poses/position") == Hdf5Shape{3, 9, 3});
  CHECK(file.shape("poses/rotation") == Hdf5Shape{3, 9, 4});
  CHECK(file.read_doubles("poses/step") == std::vector<double>{0, 5, 10});
  CHECK(file.read_attribute("poses/spin", "unit") == "rad/s");
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

TEST_CASE("a run without a step has an empty record") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder(folder.path(), system, 0).finish("", "");
  CHECK(read_steps(folder.path()).empty());
  CHECK(read_poses(folder.path()).empty());
}

TEST_CASE("a full disk is an error that names the file, and spoils nothing") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record(recorder, system, 1, 10);
  recorder.flush();
  SECTION("the logs") {
    const FileSizeLimit limit(8192);
    CHECK_THAT(run_error([&] {
                 for (long step = 11; step < 2000; ++step) recorder.add_step(sample_row(step));
                 recorder.flush();
               }),
               Contains("steps.bin") && Contains("File too large"));
  }
  SECTION("steps.csv") {
    fs::create_symlink("/dev/full", folder.path() / "steps.csv.tmp");
    CHECK_THAT(run_error([&] { recorder.finish("", ""); }),
               Contains("steps.csv") && Contains("No space left"));
    CHECK_FALSE(fs::exists(folder.path() / "steps.csv"));
  }
  SECTION("record.h5") {
    fs::create_symlink("/dev/full", folder.path() / "record.h5.tmp");
    CHECK_THAT(run_error([&] { recorder.finish("", ""); }),
               Contains("record.h5") && Contains("No space left"));
    CHECK_FALSE(fs::exists(folder.path() / "record.h5"));
  }
  CHECK_FALSE(fs::exists(folder.path() / "record.h5.tmp"));
  Recorder resumed(folder.path(), system, 10);
  record(resumed, system, 11, 12);
  resumed.finish("", "");
  check_record(folder.path(), system, 12);
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
