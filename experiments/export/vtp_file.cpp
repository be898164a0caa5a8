#include "experiments/export/vtp_file.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "platform/atomic_file.hpp"
#include "platform/deflate.hpp"
#include "platform/error.hpp"
#include "platform/pack.hpp"

namespace ballast {

namespace {

constexpr std::string_view time_opening =
    "Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">";

template <class Number>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<Number, float>)
    return "Float32";
  else
    return "Int32";
}

/// Inline binary: the count of bytes (UInt64) and the bytes, as one base64 stream.
template <class Number>
void write_array(AtomicFile& file, const char* name, const std::vector<Number>& values,
                 int components = 1) {
  Packer packer;
  packer.number(std::uint64_t{values.size() * sizeof(Number)});
  packer.fixed(values);
  file.print("<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">",
             type_name<Number>(), name, components);
  file.write(base64(packer.bytes()));
  file.write("</DataArray>\n");
}

void append(std::vector<float>& values, const Vec3& vector) {
  for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(vector[k]));
}

/// Everything before the data: the header, the time, and how many of each kind follow.
void open_piece(AtomicFile& file, double time, size_t points, size_t vertices, size_t polygons) {
  file.write(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n");
  file.write("<FieldData><DataArray type=\"Float64\" ");
  file.write(time_opening);
  file.print("%.17g</DataArray></FieldData>\n", time);
  file.print(
      "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" "
      "NumberOfPolys=\"%zu\">\n",
      points, vertices, polygons);
}

/// Everything after the data: the vertices, and polygons or single points by their vertices, of
/// which `offsets` says where each one ends.
void close_piece(AtomicFile& file, const std::vector<float>& points, const char* element,
                 const std::vector<std::int32_t>& connectivity,
                 const std::vector<std::int32_t>& offsets) {
  file.write("<Points>\n");
  write_array(file, "Points", points, 3);
  file.print("</Points>\n<%s>\n", element);
  write_array(file, "connectivity", connectivity);
  write_array(file, "offsets", offsets);
  file.print("</%s>\n</Piece>\n</PolyData>\n</VTKFile>\n", element);
  file.commit();
}

}  // namespace

void write_grains_vtp(const std::filesystem::path& path, const MechanicalSystem& system,
                      const MotionState& state) {
  std::vector<float> points, mass, speed, velocity;
  std::vector<std::int32_t> connectivity, offsets, grain;
  // cell data stand once for each face: all faces of a grain carry the grain's
  for (int b = 0; b < system.grain_count; ++b) {
    const Polyhedron& shape = *system.bodies[b].shape.polyhedron;
    const auto first = static_cast<std::int32_t>(points.size() / 3);
    for (const Vec3& vertex : shape.vertices()) append(points, state.pose[b] * vertex);
    for (int f = 0; f < shape.face_count(); ++f) {
      for (const int v : shape.face(f)) connectivity.push_back(first + v);
      offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
      grain.push_back(b);
      mass.push_back(static_cast<float>(system.bodies[b].mass));
      speed.push_back(static_cast<float>(state.velocity[b].norm()));
      append(velocity, state.velocity[b]);
    }
  }
  AtomicFile file(path);
  open_piece(file, state.time, points.size() / 3, 0, offsets.size());
  file.write("<CellData Scalars=\"speed\" Vectors=\"velocity\">\n");
  write_array(file, "grain", grain);
  write_array(file, "mass", mass);
  write_array(file, "speed", speed);
  write_array(file, "velocity", velocity, 3);
  file.write("</CellData>\n");
  close_piece(file, points, "Polys", connectivity, offsets);
}

void write_contacts_vtp(const std::filesystem::path& path, double time,
                        std::span<const ContactPoint> contacts, std::span<const Vec3> impulses,
                        double h) {
  std::vector<float> points, gap, normal_force, force;
  std::vector<std::int32_t> connectivity, offsets;
  // Each contact is a cell of one point.
  for (size_t c = 0; c < contacts.size(); ++c) {
    append(points, contacts[c].position);
    gap.push_back(static_cast<float>(contacts[c].gap));
    append(force, impulses[c] / h);
    append(normal_force, impulses[c].dot(contacts[c].normal) / h * contacts[c].normal);
    connectivity.push_back(static_cast<std::int32_t>(c));
    offsets.push_back(static_cast<std::int32_t>(c + 1));
  }
  AtomicFile file(path);
  open_piece(file, time, contacts.size(), contacts.size(), 0);
  file.write("<PointData Scalars=\"gap\" Vectors=\"normal_force\">\n");
  write_array(file, "gap", gap);
  write_array(file, "normal_force", normal_force, 3);
  write_array(file, "force", force, 3);
  file.write("</PointData>\n");
  close_piece(file, points, "Verts", connectivity, offsets);
}

void write_pvd(const std::filesystem::path& path,
               std::span<const std::pair<double, std::string>> frames) {
  AtomicFile file(path);
  file.write(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n");
  for (const auto& [time, name] : frames)
    file.print("<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n", time, name.c_str());
  file.write("</Collection>\n</VTKFile>\n");
  file.commit();
}

double read_vtp_time(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  const size_t at = text.find(time_opening);
  if (at == std::string::npos)
    throw Error(path.string() + ": is no frame of a ballast run: it has no TimeValue");
  return std::strtod(text.c_str() + at + time_opening.size(), nullptr);
}

}  // namespace ballast
