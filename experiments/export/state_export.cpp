#include "experiments/export/state_export.hpp"

#include <algorithm>
#include <cmath>

#include "experiments/export/vtp_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

constexpr std::pair<const char*, ExportFormat> format_names[] = {
    {"obj", ExportFormat::obj},
    {"text", ExportFormat::text},
    {"vtp", ExportFormat::vtp},
    {"engines", ExportFormat::engines}};

/// Blanks would split a name into columns.
std::string one_word(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= ' '; }, '_');
  return name.empty() ? "_" : name;
}

Vec3 world_spin(const MotionState& state, size_t body) {
  return state.pose[body].rotation * state.spin[body];
}

void print_vector(AtomicFile& file, const Vec3& value) {
  file.print(" %.17g %.17g %.17g", value.x(), value.y(), value.z());
}

void print_rotation(AtomicFile& file, const Quat& q) {
  file.print(" %.17g %.17g %.17g %.17g", q.w(), q.x(), q.y(), q.z());
}

/// Wavefront OBJ: polygons stay polygons.
void export_obj(const MechanicalSystem& system, const MotionState& state, const fs::path& path) {
  AtomicFile file(path);
  file.print("# ballast: %d grains at t = %.17g s, step %ld; world coordinates in m\n",
             system.grain_count, state.time, state.step);
  int first = 1;  // OBJ counts vertices from 1, through the whole file
  for (int b = 0; b < system.grain_count; ++b) {
    const Polyhedron& shape = *system.bodies[b].shape.polyhedron;
    file.print("o %s\n", one_word(system.bodies[b].name).c_str());
    for (const Vec3& vertex : shape.vertices()) {
      file.write("v");
      print_vector(file, state.pose[b] * vertex);
      file.write("\n");
    }
    for (int f = 0; f < shape.face_count(); ++f) {
      file.write("f");
      for (const int v : shape.face(f)) file.print(" %d", first + v);
      file.write("\n");
    }
    first += shape.vertex_count();
  }
  file.commit();
}

/// Columns of fixed width, so that a reader can line them up and a program can split at blanks.
void export_text(const MechanicalSystem& system, const MotionState& state, const fs::path& path) {
  AtomicFile file(path);
  file.print(
      "# ballast: %zu bodies at t = %.17g s, step %ld; SI units, world frame; q: body frame "
      "(principal axes) to "
      "world\n",
      system.bodies.size(), state.time, state.step);
  file.print("%-16s", "name");
  for (const char* column :
       {"mass", "x", "y", "z", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"})
    file.print(" %24s", column);
  file.write("\n");
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    const RigidBody& body = system.bodies[b];
    const Pose& pose = state.pose[b];
    const Vec3 &v = state.velocity[b], w = world_spin(state, b);
    const Quat& q = pose.rotation;
    file.print("%-16s", one_word(body.name).c_str());
    for (const double value :
         {body.mass, pose.position.x(), pose.position.y(), pose.position.z(), q.w(), q.x(), q.y(),
          q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()})
      file.print(" %24.17g", value);
    file.write("\n");
  }
  file.commit();
}

/// The square box of the engines' format: side L, and where its floor's centre lies in our world.
struct EngineBox {
  double side = 0.0;
  Vec3 centre = Vec3::Zero();
};

EngineBox engine_box(const MechanicalSystem& system, const MotionState& state,
                     const fs::path& path) {
  const double unset = std::nan("");
  double lo[3] = {unset, unset, unset}, hi[3] = {unset, unset, unset};
  // a wall whose normal points along an axis is the box's lower side there, against it the upper
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    if (!system.bodies[b].is_wall()) continue;
    const Vec3 normal = state.pose[b].rotation * system.bodies[b].shape.plane.normal;
    for (int axis = 0; axis < 3; ++axis) {
      if (normal[axis] > 1.0 - 1e-12) lo[axis] = state.pose[b].position[axis];
      if (normal[axis] < -1.0 + 1e-12) hi[axis] = state.pose[b].position[axis];
    }
  }
  const double width_x = hi[0] - lo[0], width_y = hi[1] - lo[1];
  if (!(width_x > 0.0 && width_y > 0.0) || std::isnan(lo[2]))
    throw Error(path.string() +
                ": cannot write as 'engines': the system has no floor and four upright walls");
  const double side = std::max(width_x, width_y);
  if (std::abs(width_x - width_y) > 0.01 * side)
    throw Error(path.string() + ": cannot write as 'engines': the box is " +
                std::to_string(width_x) + " m by " + std::to_string(width_y) +
                " m, that format has square ones only");
  return {side, Vec3(0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1]), lo[2])};
}

/// One grain of the scene: the counts, the constants, the pose, then its shape as triangles.
void write_engine_grain(AtomicFile& file, const RigidBody& body, const Pose& pose,
                        const Vec3& centre) {
  const Polyhedron& shape = *body.shape.polyhedron;
  // A polygon of n corners is a fan of n - 2 triangles.
  size_t triangles = 0;
  for (int f = 0; f < shape.face_count(); ++f) triangles += shape.face(f).size() - 2;
  file.print("%d %zu %.17g %.17g", shape.vertex_count(), triangles, shape.circumradius(),
             body.mass);
  print_vector(file, body.inertia);
  print_vector(file, pose.position - centre);
  print_rotation(file, pose.rotation);
  file.write("\n");
  for (const Vec3& v : shape.vertices()) file.print("%.17g %.17g %.17g\n", v.x(), v.y(), v.z());
  for (int f = 0; f < shape.face_count(); ++f) {
    const auto loop = shape.face(f);
    for (size_t k = 2; k < loop.size(); ++k)
      file.print("%d %d %d\n", loop[0], loop[k - 1], loop[k]);
  }
}

void export_engines(const MechanicalSystem& system, const MotionState& state,
                    const fs::path& path) {
  const EngineBox box = engine_box(system, state, path);
  double volume = 0.0;
  for (int b = 0; b < system.grain_count; ++b) volume += system.bodies[b].volume;
  AtomicFile scene(path), motion(path.string() + ".state");
  // A line for all: number of grains, side of the box, friction, density; then grain by grain.
  scene.print("%d %.17g %.17g %.17g\n", system.grain_count, box.side, system.friction,
              system.mass_of_grains() / volume);
  for (int b = 0; b < system.grain_count; ++b) {
    write_engine_grain(scene, system.bodies[b], state.pose[b], box.centre);
    const Vec3 position = state.pose[b].position - box.centre;
    motion.print("%.17g %.17g %.17g", position.x(), position.y(), position.z());
    print_rotation(motion, state.pose[b].rotation);
    print_vector(motion, state.velocity[b]);
    print_vector(motion, world_spin(state, b));
    motion.write("\n");
  }
  scene.commit();
  motion.commit();
}

}  // namespace

ExportFormat export_format(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, format] : format_names) {
    if (name == known) return format;
    names.emplace_back(known);
  }
  throw Error("no export format '" + name + "'" + did_you_mean(name, names) + ": there are " +
              joined(names));
}

ExportFormat export_format_of_suffix(const fs::path& file) {
  const std::string suffix = file.extension().string();
  if (suffix == ".obj") return ExportFormat::obj;
  if (suffix == ".txt") return ExportFormat::text;
  if (suffix == ".vtp") return ExportFormat::vtp;
  throw Error(file.string() + ": the suffix '" + suffix +
              "' says no format: give .obj, .txt or .vtp, or --format");
}

fs::path series_file(const fs::path& file, long step) {
  return file.parent_path() /
         (file.stem().string() + printed("_%08ld", step) + file.extension().string());
}

void export_series(const MechanicalSystem& system, std::span<const MotionState> states,
                   ExportFormat format, const fs::path& file) {
  if (file.has_parent_path()) create_folder(file.parent_path());
  std::vector<std::pair<double, std::string>> frames;
  for (const MotionState& state : states) {
    const fs::path frame = series_file(file, state.step);
    export_state(system, state, format, frame);
    frames.emplace_back(state.time, frame.filename().string());
  }
  if (format == ExportFormat::vtp) write_pvd(fs::path(file).replace_extension(".pvd"), frames);
}

void export_state(const MechanicalSystem& system, const MotionState& state, ExportFormat format,
                  const fs::path& file) {
  switch (format) {
    case ExportFormat::obj:
      return export_obj(system, state, file);
    case ExportFormat::text:
      return export_text(system, state, file);
    case ExportFormat::vtp:
      return write_grains_vtp(file, system, state);
    case ExportFormat::engines:
      return export_engines(system, state, file);
  }
}

}  // namespace ballast
