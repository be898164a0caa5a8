#include "experiments/export/paraview.hpp"
#include "experiments/export/state_export.hpp"
#include "experiments/export/vtp_file.hpp"
#include "geometry/shape/mass_properties.hpp"
#include "geometry/shape/mesh_file.hpp"
#include "tests/experiments/export/xml_sample.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

std::vector<ContactPoint> sample_contacts(int count) {
  Random random(8);
  std::vector<ContactPoint> contacts;
  for (int c = 0; c < count; ++c)
    contacts.push_back(
        {0, c + 1, 7, random_direction(random), random_direction(random), random.uniform(-1, 1)});
  return contacts;
}

std::vector<std::string> pvd_files(const fs::path& file) {
  std::vector<std::string> names;
  for (const XmlElement& element : parse_xml(file_bytes(file)))
    if (element.name == "DataSet")
      names.push_back(element.attributes.at("file") + " " + element.attributes.at("timestep"));
  return names;
}

}  // namespace

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

TEST_CASE("vtp: well-formed, with the faces of all grains") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const MotionState state = sample_state(system, 3);
  const fs::path file = folder.path() / "state.vtp";
  export_state(system, state, ExportFormat::vtp, file);
  const auto elements = parse_xml(file_bytes(file));
  const auto points = vtk_array<float>(elements, "Points"),
             speed = vtk_array<float>(elements, "speed"),
             velocity = vtk_array<float>(elements, "velocity"),
             mass = vtk_array<float>(elements, "mass");
  const auto connectivity = vtk_array<std::int32_t>(elements, "connectivity"),
             offsets = vtk_array<std::int32_t>(elements, "offsets"),
             grain = vtk_array<std::int32_t>(elements, "grain");
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
  for (const XmlElement& element : elements) {
    if (element.name != "Piece") continue;
    CHECK(element.attributes.at("NumberOfPoints") == std::to_string(point));
    CHECK(element.attributes.at("NumberOfPolys") == std::to_string(face));
  }
  CHECK(read_vtp_time(file) == state.time);
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

TEST_CASE("a ParaView series goes on after the step of the checkpoint") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  const auto contacts = sample_contacts(4);
  const std::vector<Vec3> impulses(4, Vec3(0, 0, 2e-4));
  const fs::path paraview = folder.path() / "paraview";
  {
    ParaviewSeries series(folder.path(), system, 0);
    for (long step : {0, 50, 100, 150})
      series.add(sample_state(system, step), contacts, impulses, 2e-4);
  }
  fs::remove(paraview / "grains.pvd");  // died before it was written
  put_bytes(paraview / "grains_00000200.vtp.tmp", "half a frame");
  put_bytes(paraview / "grains_of_salt.vtp", "not ours");
  {
    ParaviewSeries series(folder.path(), system, 120);
    CHECK(pvd_files(paraview / "grains.pvd").size() == 3);
    CHECK_FALSE(fs::exists(paraview / "grains_00000150.vtp"));
    CHECK_FALSE(fs::exists(paraview / "contacts_00000150.vtp"));
    series.add(sample_state(system, 150));
  }
  CHECK(pvd_files(paraview / "grains.pvd") ==
        std::vector<std::string>{"grains_00000000.vtp 0", "grains_00000050.vtp 0.01",
                                 "grains_00000100.vtp 0.02",
                                 "grains_00000150.vtp 0.030000000000000002"});
  CHECK(pvd_files(paraview / "contacts.pvd").size() == 3);
  CHECK(file_bytes(paraview / "grains_of_salt.vtp") == "not ours");
  ParaviewSeries afresh(folder.path(), system, 0);
  CHECK(pvd_files(paraview / "grains.pvd").empty());
  CHECK_FALSE(fs::exists(paraview / "grains_00000000.vtp"));
}

TEST_CASE("contacts as points with forces") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "contacts.vtp";
  for (int count : {0, 5}) {
    const auto contacts = sample_contacts(count);
    std::vector<Vec3> impulses;
    for (const ContactPoint& contact : contacts)
      impulses.push_back(2e-4 * (3.0 * contact.normal + contact.normal.unitOrthogonal()));
    write_contacts_vtp(file, 0.1, contacts, impulses, 2e-4);
    const auto elements = parse_xml(file_bytes(file));
    const auto normal_force = vtk_array<float>(elements, "normal_force"),
               points = vtk_array<float>(elements, "Points"),
               force = vtk_array<float>(elements, "force"), gap = vtk_array<float>(elements, "gap");
    REQUIRE((points.size() == 3u * count && gap.size() == 1u * count));
    CHECK(vtk_array<std::int32_t>(elements, "offsets").size() == static_cast<size_t>(count));
    for (int c = 0; c < count; ++c)
      for (int k = 0; k < 3; ++k) {
        CHECK(points[3 * c + k] == static_cast<float>(contacts[c].position[k]));
        CHECK(normal_force.at(3 * c + k) == Approx(3.0 * contacts[c].normal[k]).margin(1e-6));
        CHECK(force.at(3 * c + k) == Approx(impulses[c][k] / 2e-4).margin(1e-6));
      }
  }
}
