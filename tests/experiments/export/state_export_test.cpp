#include "experiments/export/state_export.hpp"

#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("formats are found by name") {
  CHECK(export_format("engines") == ExportFormat::engines);
  CHECK_THAT(run_error([] { export_format("OBJ"); }),
             Contains("'OBJ'") && Contains("obj, text, vtp, engines"));
}

TEST_CASE("obj: a grain comes back as a mesh, in its place") {
  const TemporaryFolder folder;
  MechanicalSystem system = sample_system();
  MotionState state = sample_state(system, 3);
  system.bodies.erase(system.bodies.begin() + 1, system.bodies.begin() + 3);
  system.grain_count = 1;
  export_state(system, state, ExportFormat::obj, folder.path() / "grain.obj");
  const PrincipalShape read = to_principal_frame(read_mesh(folder.path() / "grain.obj"));
  CHECK(read.volume == Approx(system.bodies[0].volume).epsilon(1e-12));
  CHECK((read.pose.position - state.pose[0].position).norm() < 1e-14);
  CHECK((read.inertia * 2700.0 - system.bodies[0].inertia).norm() <
        1e-12 * system.bodies[0].inertia.norm());
}

TEST_CASE("obj: every grain is an object of its own vertices") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const MotionState state = sample_state(system, 3);
  export_state(system, state, ExportFormat::obj, folder.path() / "all.obj");
  std::istringstream lines(file_bytes(folder.path() / "all.obj"));
  std::vector<std::string> objects;
  std::vector<Vec3> vertices;
  std::vector<size_t> first, faces;
  for (std::string line, word; std::getline(lines, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "o") {
      objects.push_back(line.substr(2));
      first.push_back(vertices.size());
      faces.push_back(0);
    } else if (word == "v") {
      Vec3 vertex;
      REQUIRE((words >> vertex[0] >> vertex[1] >> vertex[2]));
      vertices.push_back(vertex);
    } else if (word == "f") {
      for (size_t index; words >> index;) CHECK((index > first.back() && index <= vertices.size()));
      ++faces.back();
    }
  }
  REQUIRE(objects == std::vector<std::string>{"grain_0", "grain_1", "grain_2"});
  for (int b = 0; b < 3; ++b) {
    const Polyhedron& shape = *system.bodies[b].shape.polyhedron;
    CHECK(faces[b] == static_cast<size_t>(shape.face_count()));
    for (int v = 0; v < shape.vertex_count(); ++v)
      CHECK(vertices[first[b] + v] == state.pose[b] * shape.vertex(v));
  }
}

TEST_CASE("text: one row per body, full precision, spin in the world frame") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const MotionState state = sample_state(system, 3);
  export_state(system, state, ExportFormat::text, folder.path() / "state.txt");
  std::istringstream lines(file_bytes(folder.path() / "state.txt"));
  std::string line, name;
  REQUIRE((std::getline(lines, line) && line[0] == '#'));
  REQUIRE((std::getline(lines, line) && line.rfind("name ", 0) == 0));
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    REQUIRE(std::getline(lines, line));
    std::istringstream words(line);
    double mass, x[13];
    REQUIRE((words >> name >> mass));
    for (double& value : x) REQUIRE((words >> value));
    CHECK_FALSE(words >> name);
    CHECK(mass == system.bodies[b].mass);
    CHECK(Vec3(x) == state.pose[b].position);
    CHECK(x[3] == state.pose[b].rotation.w());
    CHECK(Vec3(x + 4) == state.pose[b].rotation.vec());
    CHECK(Vec3(x + 7) == state.velocity[b]);
    const Quat q(x[3], x[4], x[5], x[6]);
    CHECK((q.conjugate() * Vec3(x + 10) - state.spin[b]).norm() < 1e-14);
  }
  CHECK_FALSE(std::getline(lines, line));
}

TEST_CASE("engines: what the benches' own reader would read") {
  const TemporaryFolder folder;
  MechanicalSystem system = sample_system();
  MotionState state = sample_state(system, 3);
  const fs::path file = folder.path() / "scene.txt";
  export_state(system, state, ExportFormat::engines, file);
  std::istringstream scene(file_bytes(file)), motion(file_bytes(file.string() + ".state"));
  int count;
  double side, mu, density;
  REQUIRE((scene >> count >> side >> mu >> density));
  CHECK((count == 3 && side == 0.6 && mu == 0.4 && density == Approx(2700.0).epsilon(1e-14)));
  for (int b = 0; b < count; ++b) {
    int vertex_count, face_count;
    double r, mass, head[10], row[13];
    REQUIRE((scene >> vertex_count >> face_count >> r >> mass));
    for (double& value : head) REQUIRE((scene >> value));
    const RigidBody& body = system.bodies[b];
    CHECK((mass == body.mass && r == body.shape.polyhedron->circumradius() &&
           Vec3(head) == body.inertia));
    std::vector<Vec3> vertices(vertex_count);
    for (Vec3& vertex : vertices) REQUIRE((scene >> vertex[0] >> vertex[1] >> vertex[2]));
    double volume = 0.0;
    for (int f = 0; f < face_count; ++f) {
      int i, j, k;
      REQUIRE((scene >> i >> j >> k));
      volume += vertices.at(i).dot(vertices.at(j).cross(vertices.at(k))) / 6.0;
    }
    CHECK(volume == Approx(body.volume).epsilon(1e-12));
    for (double& value : row) REQUIRE((motion >> value));
    for (int k = 0; k < 7; ++k) CHECK(row[k] == head[3 + k]);
    CHECK((Vec3(row) + Vec3(0.3, 0.3, 0.0) - state.pose[b].position).norm() < 1e-15);
    CHECK(Vec3(row + 7) == state.velocity[b]);
    CHECK(Vec3(row + 10) == state.pose[b].rotation * state.spin[b]);
  }
  std::string rest;
  CHECK_FALSE((scene >> rest || motion >> rest));

  state.pose[6].position.x() = 0.58;  // the driven wall
  CHECK_THAT(run_error([&] { export_state(system, state, ExportFormat::engines, file); }),
             Contains("square"));
  system.bodies.pop_back();
  CHECK_THAT(run_error([&] { export_state(system, state, ExportFormat::engines, file); }),
             Contains("four upright walls"));
}

TEST_CASE("a file that cannot be written is an error that names it") {
  const MechanicalSystem system = sample_system();
  const MotionState state = sample_state(system, 3);
  for (const ExportFormat format :
       {ExportFormat::obj, ExportFormat::text, ExportFormat::vtp, ExportFormat::engines}) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "out";
    fs::create_symlink("/dev/full", file.string() + ".tmp");
    CHECK_THAT(run_error([&] { export_state(system, state, format, file); }),
               Contains(file.string()) && Contains("No space left"));
    CHECK(fs::is_empty(folder.path()));
    const fs::path nowhere = folder.path() / "no" / "out";
    CHECK_THAT(run_error([&] { export_state(system, state, format, nowhere); }),
               Contains(nowhere.string()));
  }
}

TEST_CASE("a suffix says the format, and a slip of the finger is recognised") {
  CHECK(export_format_of_suffix("a/b.obj") == ExportFormat::obj);
  CHECK(export_format_of_suffix("b.vtp") == ExportFormat::vtp);
  CHECK(export_format_of_suffix("b.txt") == ExportFormat::text);
  for (const char* name : {"b", "b.png", "obj"})
    CHECK_THAT(run_error([&] { export_format_of_suffix(name); }), Contains("says no format"));
  CHECK_THAT(run_error([] { export_format("vpt"); }), Contains("did you mean \"vtp\"?"));
}

TEST_CASE("a whole series: a file for each state, and for ParaView a list with their times") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const std::vector<MotionState> states{sample_state(system, 0), sample_state(system, 50)};
  const fs::path series = folder.path() / "series";
  export_series(system, states, ExportFormat::vtp, series / "grains.vtp");
  for (const MotionState& state : states) {
    const fs::path alone = folder.path() / "alone.vtp";
    export_state(system, state, ExportFormat::vtp, alone);
    CHECK((file_bytes(series_file(series / "grains.vtp", state.step)) == file_bytes(alone)));
  }
  CHECK(series_file("a/grains.vtp", 50) == fs::path("a/grains_00000050.vtp"));
  const std::string list = file_bytes(series / "grains.pvd");
  CHECK_THAT(list, Contains("timestep=\"0\" part=\"0\" file=\"grains_00000000.vtp\"") &&
                       Contains("file=\"grains_00000050.vtp\""));
  export_series(system, states, ExportFormat::text, series / "state.txt");
  CHECK(fs::exists(series / "state_00000050.txt"));
  CHECK_FALSE(fs::exists(series / "state.pvd"));
}
