#include "experiments/export/vtp_file.hpp"

#include "experiments/export/state_export.hpp"
#include "tests/experiments/export/sample_contacts.hpp"
#include "tests/experiments/export/xml_sample.hpp"

using namespace ballast;
namespace fs = std::filesystem;

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
