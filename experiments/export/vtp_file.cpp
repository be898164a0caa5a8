#include "experiments/export/vtp_file.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "platform/atomic_file.hpp"
#include "platform/deflate.hpp"
#include "platform/error.hpp"
#include "platform/pack.hpp"
#include "platform/text.hpp"

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

namespace fs = std::filesystem;

namespace {

/// Step of "<name>_<digits>.vtp", or -1.
long step_of_frame(const std::string& file, const std::string& name) {
  const std::string prefix = name + "_", suffix = ".vtp";
  if (file.size() <= prefix.size() + suffix.size() || file.rfind(prefix, 0) != 0 ||
      !file.ends_with(suffix))
    return -1;
  const size_t digits = file.size() - prefix.size() - suffix.size();
  return parsed<long>(std::string_view(file).substr(prefix.size(), digits)).value_or(-1);
}

}  // namespace

ParaviewSeries::ParaviewSeries(const fs::path& folder, const MechanicalSystem& system,
                               long last_step)
    : folder_(folder / "paraview"), system_(system) {
  create_folder(folder_);
  recover(grains_, last_step);
  recover(contacts_, last_step);
}

/// What the folder holds decides, not an old .pvd: a run may have died between a frame and its
/// entry.
void ParaviewSeries::recover(Series& series, long last_step) {
  std::vector<fs::path> obsolete;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    const long step = step_of_frame(entry.path().filename().string(), series.name);
    if (step < 0) continue;
    if (last_step > 0 && step <= last_step)
      series.frames.push_back({step, read_vtp_time(entry.path())});
    else
      obsolete.push_back(entry.path());
  }
  std::sort(series.frames.begin(), series.frames.end(),
            [](const Frame& a, const Frame& b) { return a.step < b.step; });
  write_collection(series);  // first: it must not name what is gone
  for (const fs::path& file : obsolete) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw Error(file.string() + ": cannot remove: " + error.message());
  }
}

fs::path ParaviewSeries::frame_file(const Series& series, long step) const {
  return folder_ / printed("%s_%08ld.vtp", series.name, step);
}

void ParaviewSeries::write_collection(const Series& series) const {
  const fs::path target = folder_ / (std::string(series.name) + ".pvd");
  if (series.frames.empty() && !is_there(target)) return;
  std::vector<std::pair<double, std::string>> frames;
  for (const Frame& frame : series.frames)
    frames.emplace_back(frame.time, frame_file(series, frame.step).filename().string());
  write_pvd(target, frames);
}

void ParaviewSeries::add(const MotionState& state) {
  write_grains_vtp(frame_file(grains_, state.step), system_, state);
  grains_.frames.push_back({state.step, state.time});
  write_collection(grains_);
}

void ParaviewSeries::add(const MotionState& state, std::span<const ContactPoint> contacts,
                         std::span<const Vec3> impulses, double h) {
  add(state);
  write_contacts_vtp(frame_file(contacts_, state.step), state.time, contacts, impulses, h);
  contacts_.frames.push_back({state.step, state.time});
  write_collection(contacts_);
}

}  // namespace ballast
