#include "experiments/export/state_export.hpp"

#include <algorithm>
#include <cstring>

#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "platform/text.hpp"
#include "tests/support/inflated.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// The text of a file for ParaView, checked to be well-formed.
std::string read_xml(const fs::path& file) {
  const std::string head = "<?xml version=\"1.0\"?>\n", text = file_bytes(file);
  REQUIRE(text.starts_with(head));
  CHECK(nesting_fault(text.substr(head.size())) == "");
  return text;
}

/// The numbers of the DataArray of that name: an UInt64 with the number of bytes, then the bytes.
template <class Number>
std::vector<Number> vtk_array(const std::string& xml, const std::string& name) {
  const char* type = std::is_same_v<Number, float> ? "Float32" : "Int32";
  const std::string tag = printed("<DataArray type=\"%s\" Name=\"%s\"", type, name.c_str());
  REQUIRE(xml.find(tag) != std::string::npos);
  const size_t begin = xml.find('>', xml.find(tag)) + 1;
  const std::string bytes = from_base64(xml.substr(begin, xml.find('<', begin) - begin));
  std::uint64_t length = 0;
  REQUIRE(bytes.size() >= sizeof length);
  std::memcpy(&length, bytes.data(), sizeof length);
  REQUIRE(bytes.size() == sizeof length + length);
  std::vector<Number> values(length / sizeof(Number));
  std::copy_n(bytes.data() + sizeof length, length, reinterpret_cast<char*>(values.data()));
  return values;
}

}  // namespace

TEST_CASE("obj: a grain comes back as a mesh, in its place") {
  const TemporaryFolder folder;
  MechanicalSystem system = sample_system();
  MotionState state = sample_state(system, 3);
  system.bodies.erase(system.bodies.begin() + 1, system.bodies.begin() + 3);
  system.grain_count = 1;
  export_state(system, state, folder.path() / "grain.obj");
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
  export_state(system, state, folder.path() / "all.obj");
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

TEST_CASE("a body of parts is exported part by part") {
  const TemporaryFolder folder;
  const auto cube = std::make_shared<const Polyhedron>(make_box(Vec3(1, 1, 1)));
  const std::vector<PlacedShape> cubes{{cube, {Vec3(2, 0, 0), Quat::Identity()}}, {cube, {}}};
  const CompoundShape compound = make_compound(cubes);
  BodySpec spec;
  spec.name = "two";
  spec.shape = compound.hull;
  spec.parts = compound.parts;
  spec.pose = compound.pose;
  MechanicalSystem system;
  MotionState state;
  add_body(system, state, spec, compound.volume);
  export_state(system, state, folder.path() / "two.obj");
  const std::string text = file_bytes(folder.path() / "two.obj");
  const auto count = [&](const char* word) {
    long found = 0;
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  CHECK((count("\nv ") == 16 && count("\nf ") == 12 && count("\no ") == 1));
  CHECK(text.find("v 2.5 ") != std::string::npos);
  export_state(system, state, folder.path() / "two.vtp");
  const std::string xml = read_xml(folder.path() / "two.vtp");
  CHECK(vtk_array<float>(xml, "Points").size() == 48);
  CHECK(vtk_array<std::int32_t>(xml, "grain") == std::vector<std::int32_t>(12, 0));
}

TEST_CASE("vtp: well-formed, with the faces of all grains") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const MotionState state = sample_state(system, 3);
  const fs::path file = folder.path() / "state.vtp";
  export_state(system, state, file);
  const std::string xml = read_xml(file);
  const auto points = vtk_array<float>(xml, "Points"), speed = vtk_array<float>(xml, "speed"),
             velocity = vtk_array<float>(xml, "velocity"), mass = vtk_array<float>(xml, "mass");
  const auto connectivity = vtk_array<std::int32_t>(xml, "connectivity"),
             offsets = vtk_array<std::int32_t>(xml, "offsets"),
             grain = vtk_array<std::int32_t>(xml, "grain");
  size_t point = 0, face = 0;
  std::int32_t begin = 0;
  for (int b = 0; b < 3; ++b) {
    const Polyhedron& shape = *system.bodies[b].shape.polyhedron;
    for (int f = 0; f < shape.face_count(); ++f, ++face) {
      CHECK((grain.at(face) == b && mass.at(face) == static_cast<float>(system.bodies[b].mass)));
      CHECK(speed.at(face) == static_cast<float>(state.velocity[b].norm()));
      CHECK(velocity.at(3 * face + 2) == static_cast<float>(state.velocity[b].z()));
      REQUIRE(offsets.at(face) - begin == static_cast<std::int32_t>(shape.face(f).size()));
      for (const int v : shape.face(f))
        CHECK(connectivity.at(begin++) == static_cast<std::int32_t>(point) + v);
    }
    for (const Vec3& vertex : shape.vertices()) {
      const Vec3 expected = state.pose[b] * vertex;
      for (int k = 0; k < 3; ++k)
        CHECK(points.at(3 * point + k) == static_cast<float>(expected[k]));
      ++point;
    }
  }
  CHECK((points.size() == 3 * point && offsets.size() == face &&
         connectivity.size() == static_cast<size_t>(begin)));
  CHECK_THAT(xml, Contains(printed("NumberOfPoints=\"%zu\"", point)) &&
                      Contains(printed("NumberOfPolys=\"%zu\"", face)) &&
                      Contains(printed("\"ascii\">%.17g<", state.time)));
}

TEST_CASE(
    "a file that cannot be written, and a suffix that says no format, are errors that name it") {
  const MechanicalSystem system = sample_system();
  const MotionState state = sample_state(system, 3);
  for (const char* name : {"out.obj", "out.vtp"}) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / name;
    fs::create_symlink("/dev/full", file.string() + ".tmp");
    CHECK_THAT(run_error([&] { export_state(system, state, file); }),
               Contains(file.string()) && Contains("No space left"));
    CHECK(fs::is_empty(folder.path()));
    const fs::path nowhere = folder.path() / "no" / name;
    CHECK_THAT(run_error([&] { export_state(system, state, nowhere); }),
               Contains(nowhere.string()));
  }
  for (const char* name : {"b", "b.txt", "obj"})
    CHECK_THAT(run_error([&] { export_state(system, state, name); }),
               Contains(name) && Contains("says no format"));
}

TEST_CASE("a series: files for ParaView with their times, and the contacts of a record") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const std::vector<MotionState> states{sample_state(system, 0), sample_state(system, 50)};
  StepMemory memory;
  for (int c = 0; c < 3; ++c) {
    memory.contacts.push_back({c, c + 1, 7, Vec3::UnitZ(), Vec3(c, 2, 3), -1e-6});
    memory.impulses.push_back(2e-4 * Vec3(0.5, 0, 3.0 + c));
  }
  Recorder recorder(folder.path(), system, 0, true);
  for (const MotionState& state : states) {
    recorder.add_frame(state, memory, 2e-4);
  }
  recorder.finish("", "");
  const RecordForces forces(folder.path() / "record.h5");
  const fs::path series = folder.path() / "series";
  fs::create_directory(series);
  write_series(
      states, [&](size_t k) { return forces.of_frame(k); }, series / "grains.vtp");
  CHECK(series_file("a/grains.vtp", 50) == fs::path("a/grains_00000050.vtp"));
  CHECK_THAT(file_bytes(series / "grains.pvd"),
             Contains("timestep=\"0\" part=\"0\" file=\"grains_00000000.vtp\"") &&
                 Contains("file=\"grains_00000050.vtp\""));
  CHECK_THAT(file_bytes(series / "grains_contacts.pvd"),
             Contains("timestep=\"0.01\" part=\"0\" file=\"grains_contacts_00000050.vtp\""));
  // Before the first step there are no contacts.
  for (const int count : {0, 3}) {
    const fs::path file = series_file(series / "grains_contacts.vtp", count == 0 ? 0 : 50);
    const std::string xml = read_xml(file);
    const auto points = vtk_array<float>(xml, "Points"), force = vtk_array<float>(xml, "force"),
               normal_force = vtk_array<float>(xml, "normal_force");
    REQUIRE((points.size() == 3u * count && force.size() == 3u * count));
    CHECK(vtk_array<std::int32_t>(xml, "offsets").size() == static_cast<size_t>(count));
    for (int c = 0; c < count; ++c) {
      CHECK((points[3 * c] == c && points[3 * c + 2] == 3));
      CHECK(Eigen::Vector3f(force.data() + 3 * c).isApprox(Eigen::Vector3f(0.5f, 0, 3.0f + c)));
      CHECK(Eigen::Vector3f(normal_force.data() + 3 * c).isApprox(Eigen::Vector3f(0, 0, 3.0f + c)));
    }
  }
}
