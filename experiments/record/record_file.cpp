#include "experiments/record/record_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "experiments/record/bits_generation.hpp"
#include "experiments/record/force_log.hpp"
#include "experiments/record/row_parts.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_file.hpp"

namespace ballast {

namespace {

/// One block of a pose row, and dataset of /poses: `parts` numbers for each body.
struct PoseBlock {
  const char* name;
  size_t parts;
  const char *unit, *description;
};
constexpr PoseBlock pose_blocks[] = {
    {"position", 3, "m", "centre of mass, world frame"},
    {"rotation", 4, "1",
     "unit quaternion w x y z: from the body frame (principal axes) to the world frame"},
    {"velocity", 3, "m/s", "of the centre of mass, world frame"},
    {"spin", 3, "rad/s", "angular velocity, body frame"},
};
constexpr size_t parts_per_body = 13, leading = 2;  // step and time lead a pose row

void describe(Hdf5Writer& file, const std::string& dataset, const char* unit,
              const char* description) {
  file.add_attribute(dataset, "unit", unit);
  file.add_attribute(dataset, "description", description);
}

void add(Hdf5Writer& file, const std::string& name, const std::vector<double>& values,
         const Hdf5Shape& shape, const char* unit, const char* description) {
  file.add(name, values, shape);
  describe(file, name, unit, description);
}

void add_steps(Hdf5Writer& file, RowReader& rows) {
  std::vector<RowPart> parts;
  for (const StepColumn& column : step_columns())
    parts.push_back({.dataset = std::string("steps/") + column.name,
                     .begin = parts.size(),
                     .unit = column.unit,
                     .description = column.description});
  file.add_group("steps");
  add_row_parts(file, rows, parts);
}

/// Returns the steps of the frames.
std::vector<std::int64_t> add_poses(Hdf5Writer& file, RowReader& rows, size_t bodies) {
  std::vector<RowPart> parts = {
      {"poses/step", 0, {}, "1", "steps done at the frame", Hdf5Number::int64},
      {"poses/time", 1, {}, "s", "of the frame"}};
  size_t begin = leading;
  for (const PoseBlock& block : pose_blocks) {
    parts.push_back({std::string("poses/") + block.name,
                     begin,
                     {bodies, block.parts},
                     block.unit,
                     block.description});
    begin += bodies * block.parts;
  }
  std::vector<std::int64_t> steps;
  file.add_group("poses");
  add_row_parts(file, rows, parts, [&](std::span<const double> row) {
    steps.push_back(static_cast<std::int64_t>(row[0]));
  });
  return steps;
}

void add_bodies(Hdf5Writer& file, const MechanicalSystem& system) {
  // bodies that share a shape name the same one
  std::map<const Polyhedron*, std::int32_t> shape_index;
  for (size_t k = 0; k < system.shapes.size(); ++k)
    shape_index.emplace(system.shapes[k].get(), static_cast<std::int32_t>(k));
  std::vector<std::string> names;
  std::vector<double> mass, volume, inertia, normal;
  std::vector<std::int32_t> shape;
  for (const RigidBody& body : system.bodies) {
    names.push_back(body.name);
    mass.push_back(body.mass);
    volume.push_back(body.volume);
    inertia.insert(inertia.end(), body.inertia.begin(), body.inertia.end());
    const Vec3 into_free_side = body.is_wall() ? body.shape.plane.normal : Vec3::Zero();
    normal.insert(normal.end(), into_free_side.begin(), into_free_side.end());
    shape.push_back(body.is_wall() ? -1 : shape_index.at(body.shape.polyhedron));
  }
  const size_t count = names.size();
  file.add_group("bodies");
  file.add("bodies/name", names);
  add(file, "bodies/mass", mass, {count}, "kg", "mass; of a driven wall: the wall's");
  add(file, "bodies/volume", volume, {count}, "m^3", "volume; 0 for walls");
  add(file, "bodies/inertia", inertia, {count, 3}, "kg m^2", "principal moments of inertia");
  add(file, "bodies/wall_normal", normal, {count, 3}, "1",
      "body frame, into the free side; 0 for grains");
  file.add("bodies/shape", shape, {count});
  describe(file, "bodies/shape", "1", "number of the shape in /shapes; -1 for walls");
}

/// All shapes in four datasets: a group for each shape took HDF5 20 MB for 1200 of them.
void add_shapes(Hdf5Writer& file, const MechanicalSystem& system) {
  std::vector<double> vertices;
  std::vector<std::int32_t> triangles, vertex_begin{0}, triangle_begin{0};
  for (const auto& pointer : system.shapes) {
    const Polyhedron& shape = *pointer;
    for (const Vec3& vertex : shape.vertices())
      vertices.insert(vertices.end(), vertex.begin(), vertex.end());
    for (int f = 0; f < shape.face_count(); ++f) {
      // a polygon is a fan of triangles
      const auto loop = shape.face(f);
      for (size_t i = 2; i < loop.size(); ++i)
        triangles.insert(triangles.end(), {loop[0], loop[i - 1], loop[i]});
    }
    vertex_begin.push_back(static_cast<std::int32_t>(vertices.size() / 3));
    triangle_begin.push_back(static_cast<std::int32_t>(triangles.size() / 3));
  }
  file.add_group("shapes");
  add(file, "shapes/vertices", vertices, {vertices.size() / 3, 3}, "m",
      "body frame; shape after shape");
  file.add("shapes/triangles", triangles, {triangles.size() / 3, 3});
  describe(file, "shapes/triangles", "1",
           "numbers of vertices within the shape, counter-clockwise from outside");
  file.add("shapes/vertex_begin", vertex_begin, {vertex_begin.size()});
  describe(file, "shapes/vertex_begin", "1",
           "shape k has the vertices vertex_begin[k] to vertex_begin[k + 1]");
  file.add("shapes/triangle_begin", triangle_begin, {triangle_begin.size()});
  describe(file, "shapes/triangle_begin", "1",
           "shape k has the triangles triangle_begin[k] to triangle_begin[k + 1]");
}

}  // namespace

size_t pose_row_size(size_t bodies) { return leading + parts_per_body * bodies; }

void pack_pose_row(const MotionState& state, std::vector<double>& row) {
  // step, time | positions of all bodies | rotations w x y z | velocities | spins
  row.clear();
  row.push_back(static_cast<double>(state.step));
  row.push_back(state.time);
  for (const Pose& pose : state.pose)
    row.insert(row.end(), pose.position.begin(), pose.position.end());
  for (const Pose& pose : state.pose) {
    const Quat& q = pose.rotation;
    row.insert(row.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  for (const Vec3& velocity : state.velocity)
    row.insert(row.end(), velocity.begin(), velocity.end());
  for (const Vec3& spin : state.spin) row.insert(row.end(), spin.begin(), spin.end());
}

PoseFrame unpack_pose_row(std::span<const double> row) {
  const size_t bodies = (row.size() - leading) / parts_per_body;
  PoseFrame frame;
  frame.step = static_cast<long>(row[0]);
  frame.time = row[1];
  frame.pose.resize(bodies);
  frame.velocity.resize(bodies);
  frame.spin.resize(bodies);
  const double *position = row.data() + leading, *rotation = position + 3 * bodies,
               *velocity = rotation + 4 * bodies, *spin = velocity + 3 * bodies;
  for (size_t b = 0; b < bodies; ++b) {
    frame.pose[b].position = Vec3(position + 3 * b);
    frame.pose[b].rotation =
        Quat(rotation[4 * b], rotation[4 * b + 1], rotation[4 * b + 2], rotation[4 * b + 3]);
    frame.velocity[b] = Vec3(velocity + 3 * b);
    frame.spin[b] = Vec3(spin + 3 * b);
  }
  return frame;
}

void write_record_file(const std::filesystem::path& path, const MechanicalSystem& system,
                       RowReader& steps, RowReader& poses, RowReader* forces,
                       const std::string& scene_text, const std::string& manifest_text) {
  Hdf5Writer file(path, Hdf5Storage::compressed);
  file.add_attribute("/", "format", "ballast record 2");
  file.add_attribute("/", "bits_generation", std::to_string(bits_generation));
  file.add_attribute("/", "scene", scene_text);
  file.add_attribute("/", "manifest", manifest_text);
  add_steps(file, steps);
  const std::vector<std::int64_t> frame_steps = add_poses(file, poses, system.bodies.size());
  if (forces) add_forces(file, *forces, frame_steps);
  add_bodies(file, system);
  add_shapes(file, system);
  file.commit();
}

std::vector<StepRecord> read_record_steps(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  std::vector<StepRecord> steps;
  for (const StepColumn& column : step_columns()) {
    const std::string path_of_column = std::string("steps/") + column.name;
    // A record from before a column was there does not know it.
    if (&column != &step_columns().front() && !file.has(path_of_column)) {
      for (StepRecord& step : steps) step.*column.value = std::nan("");
      continue;
    }
    const std::vector<double> values = file.read_doubles(path_of_column);
    if (&column == &step_columns().front()) steps.resize(values.size());
    if (values.size() != steps.size())
      throw Error(path.string() + ": steps/" + column.name + " has another length than the rest");
    for (size_t k = 0; k < steps.size(); ++k) steps[k].*column.value = values[k];
  }
  return steps;
}

std::vector<PoseFrame> read_record_poses(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::vector<double> time = file.read_doubles("poses/time"),
                            step = file.read_doubles("poses/step");
  const Hdf5Shape shape = file.shape("poses/position");
  if (shape.size() != 3 || shape[0] != time.size() || step.size() != time.size())
    throw Error(path.string() + ": the datasets of /poses do not fit together");
  std::vector<PoseFrame> frames;
  for (size_t k = 0; k < time.size(); ++k) {
    // A frame is put together as its row stood in the log, and then taken apart like one.
    std::vector<double> row{step[k], time[k]};
    for (const PoseBlock& block : pose_blocks) {
      const std::vector<double> part = file.read_rows(std::string("poses/") + block.name, k);
      row.insert(row.end(), part.begin(), part.end());
    }
    if (row.size() != pose_row_size(shape[1]))
      throw Error(path.string() + ": the datasets of /poses do not fit together");
    frames.push_back(unpack_pose_row(row));
  }
  return frames;
}

}  // namespace ballast
