#include "experiments/export/state_export.hpp"

#include <algorithm>

#include "platform/atomic_file.hpp"
#include "platform/deflate.hpp"
#include "platform/error.hpp"
#include "platform/pack.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

/// Wavefront OBJ: polygons stay polygons.
void export_obj(const MechanicalSystem& system, const MotionState& state, const fs::path& path) {
  AtomicFile file(path);
  file.write(printed("# ballast: %d grains at t = %.17g s, step %ld; world coordinates in m\n",
                     system.grain_count, state.time, state.step));
  int first = 1;  // OBJ counts vertices from 1, through the whole file
  for (int b = 0; b < system.grain_count; ++b) {
    std::string name = system.bodies[b].name;  // blanks would split it
    std::ranges::replace_if(
        name, [](unsigned char c) { return c <= ' '; }, '_');
    file.write("o " + name + "\n");
    for (const ConvexPart& part : convex_parts(system.bodies[b].shape)) {
      const Polyhedron& shape = *part.polyhedron;
      for (const Vec3& vertex : shape.vertices()) {
        const Vec3 place = state.pose[b] * (part.pose * vertex);
        file.write(printed("v %.17g %.17g %.17g\n", place.x(), place.y(), place.z()));
      }
      for (int f = 0; f < shape.face_count(); ++f) {
        file.write("f");
        for (const int v : shape.face(f)) file.write(printed(" %d", first + v));
        file.write("\n");
      }
      first += shape.vertex_count();
    }
  }
  file.commit();
}

/// Inline binary: the count of bytes (UInt64) and the bytes, as one base64 stream.
template <class Number>
void write_array(AtomicFile& file, const char* name, const std::vector<Number>& values,
                 int components = 1) {
  Packer packer;
  packer.number(std::uint64_t{values.size() * sizeof(Number)});
  packer.fixed(values);
  file.write(
      printed("<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">",
              std::is_same_v<Number, float> ? "Float32" : "Int32", name, components));
  file.write(base64(packer.bytes()));
  file.write("</DataArray>\n");
}

template <class Vector>
void append(std::vector<float>& values, const Vector& vector) {
  for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(vector[k]));
}

/// Polygons or single points by their vertices; `offsets` has the end of each one.
struct VtpCells {
  std::vector<float> points;
  std::vector<std::int32_t> connectivity, offsets;
};

/// `element`: "Polys" or "Verts"; `write_data` writes the arrays that belong to them.
template <class WriteData>
void write_vtp(const fs::path& path, double time, const std::string& element, const VtpCells& cells,
               WriteData&& write_data) {
  AtomicFile file(path);
  file.write(
      printed("<?xml version=\"1.0\"?>\n"
              "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
              "header_type=\"UInt64\">\n<PolyData>\n"
              "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
              "format=\"ascii\">%.17g</DataArray></FieldData>\n",
              time));
  const size_t count = cells.offsets.size();
  file.write(printed(
      "<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n",
      cells.points.size() / 3, element == "Verts" ? count : 0, element == "Polys" ? count : 0));
  write_data(file);
  file.write("<Points>\n");
  write_array(file, "Points", cells.points, 3);
  file.write("</Points>\n<" + element + ">\n");
  write_array(file, "connectivity", cells.connectivity);
  write_array(file, "offsets", cells.offsets);
  file.write("</" + element + ">\n</Piece>\n</PolyData>\n</VTKFile>\n");
  file.commit();
}

void write_grains_vtp(const MechanicalSystem& system, const MotionState& state,
                      const fs::path& path) {
  VtpCells cells;
  std::vector<float> mass, speed, velocity;
  std::vector<std::int32_t> grain;
  // cell data are per face: all faces of a grain carry the values of the grain
  for (int b = 0; b < system.grain_count; ++b) {
    for (const ConvexPart& part : convex_parts(system.bodies[b].shape)) {
      const Polyhedron& shape = *part.polyhedron;
      const auto first = static_cast<std::int32_t>(cells.points.size() / 3);
      for (const Vec3& vertex : shape.vertices())
        append(cells.points, state.pose[b] * (part.pose * vertex));
      for (int f = 0; f < shape.face_count(); ++f) {
        for (const int v : shape.face(f)) cells.connectivity.push_back(first + v);
        cells.offsets.push_back(static_cast<std::int32_t>(cells.connectivity.size()));
        grain.push_back(b);
        mass.push_back(static_cast<float>(system.bodies[b].mass));
        speed.push_back(static_cast<float>(state.velocity[b].norm()));
        append(velocity, state.velocity[b]);
      }
    }
  }
  write_vtp(path, state.time, "Polys", cells, [&](AtomicFile& file) {
    file.write("<CellData Scalars=\"speed\" Vectors=\"velocity\">\n");
    write_array(file, "grain", grain);
    write_array(file, "mass", mass);
    write_array(file, "speed", speed);
    write_array(file, "velocity", velocity, 3);
    file.write("</CellData>\n");
  });
}

/// Each contact is a cell of one point.
void write_contacts_vtp(const std::vector<FrameContact>& contacts, double time,
                        const fs::path& path) {
  VtpCells cells;
  std::vector<float> force, normal_force;
  for (const FrameContact& contact : contacts) {
    append(cells.points, contact.position);
    append(force, contact.force);
    append(normal_force, contact.force.dot(contact.normal) * contact.normal);
    cells.connectivity.push_back(static_cast<std::int32_t>(cells.offsets.size()));
    cells.offsets.push_back(static_cast<std::int32_t>(cells.connectivity.size()));
  }
  write_vtp(path, time, "Verts", cells, [&](AtomicFile& file) {
    file.write("<PointData Vectors=\"normal_force\">\n");
    write_array(file, "force", force, 3);
    write_array(file, "normal_force", normal_force, 3);
    file.write("</PointData>\n");
  });
}

/// A .pvd beside the files of a series: it names them with their times [s].
void write_pvd(const fs::path& series, std::span<const MotionState> states) {
  AtomicFile file(fs::path(series).replace_extension(".pvd"));
  file.write(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n");
  for (const MotionState& state : states)
    file.write(printed("<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n", state.time,
                       series_file(series, state.step).filename().c_str()));
  file.write("</Collection>\n</VTKFile>\n");
  file.commit();
}

}  // namespace

void export_state(const MechanicalSystem& system, const MotionState& state, const fs::path& file) {
  const std::string suffix = file.extension().string();
  if (suffix == ".obj") return export_obj(system, state, file);
  if (suffix == ".vtp") return write_grains_vtp(system, state, file);
  throw Error(file.string() + ": the suffix '" + suffix +
              "' says no format: give .obj, .vtp or, for a picture, .png");
}

fs::path series_file(const fs::path& file, long step) {
  return file.parent_path() /
         (file.stem().string() + printed("_%08ld", step) + file.extension().string());
}

void write_series(std::span<const MotionState> states,
                  const std::function<std::vector<FrameContact>(size_t)>& contacts_of,
                  const fs::path& file) {
  write_pvd(file, states);
  if (!contacts_of) return;
  const fs::path contacts = file.parent_path() / (file.stem().string() + "_contacts.vtp");
  for (size_t k = 0; k < states.size(); ++k)
    write_contacts_vtp(contacts_of(k), states[k].time, series_file(contacts, states[k].step));
  write_pvd(contacts, states);
}

}  // namespace ballast
