#include "experiments/record/record_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "geometry/shape/convex_hull.hpp"
#include "platform/error.hpp"

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

void add_row_parts(Hdf5Writer& file, RowReader& rows, std::span<const RowPart> parts,
                   const std::function<void(std::span<const double> row)>& see) {
  const auto count = static_cast<size_t>(rows.safe_count());
  std::vector<Hdf5Id> datasets;
  for (const RowPart& part : parts) {
    Hdf5Shape shape = part.shape;
    shape.insert(shape.begin(), count);
    datasets.push_back(file.add_rows(part.dataset, shape, part.number));
    file.add_attribute(part.dataset, "unit", part.unit);
    file.add_attribute(part.dataset, "description", part.description);
  }
  constexpr size_t most_numbers = 1 << 17;  // that are gathered: a megabyte
  const size_t length = rows.header().row_size,
               most_rows = std::max<size_t>(1, most_numbers / length);
  std::vector<double> gathered, values;
  rows.rewind();
  for (size_t first = 0; first < count; first += gathered.size() / length) {
    // as many rows as may be gathered
    gathered.clear();
    for (size_t k = first; k < std::min(count, first + most_rows); ++k) {
      const std::span<const double> row = rows.next();
      gathered.insert(gathered.end(), row.begin(), row.end());
      if (see) see(row);
    }
    // part by part from all of them
    for (size_t p = 0; p < parts.size(); ++p) {
      const Hdf5Shape& shape = parts[p].shape;
      const auto size = std::accumulate(shape.begin(), shape.end(), size_t{1}, std::multiplies<>());
      values.clear();
      for (size_t at = parts[p].begin; at < gathered.size(); at += length)
        values.insert(values.end(), gathered.data() + at, gathered.data() + at + size);
      file.write_rows(datasets[p], first, values);
    }
  }
}

void pack_force_row(const MotionState& state, const ContactPoint& contact, const Vec3& impulse,
                    double h, std::vector<double>& row) {
  // Fourteen numbers: step, time, a, b | position x y z | normal x y z | gap | force x y z.
  row = {static_cast<double>(state.step), state.time, static_cast<double>(contact.body_a),
         static_cast<double>(contact.body_b)};
  for (const Vec3& vector : {contact.position, contact.normal})
    row.insert(row.end(), vector.begin(), vector.end());
  row.push_back(contact.gap);
  const Vec3 force = impulse / h;
  row.insert(row.end(), force.begin(), force.end());
}

void add_forces(Hdf5Writer& file, RowReader& rows, std::span<const std::int64_t> frame_steps) {
  const RowPart parts[] = {
      {"contacts/body_a", 2, {}, "1", "number of the body in /bodies", Hdf5Number::int32},
      {"contacts/body_b",
       3,
       {},
       "1",
       "number of the other body, to which the normal points",
       Hdf5Number::int32},
      {"contacts/position", 4, {3}, "m", "world frame, midway between the two surfaces"},
      {"contacts/normal", 7, {3}, "1", "unit, world frame, from a to b"},
      {"contacts/gap", 10, {}, "m", "along the normal at detection; negative: overlap"},
      {"contacts/force",
       11,
       {3},
       "N",
       "on body b, world frame: the step's impulse over its length"},
  };
  file.add_group("contacts");
  // Rows and frames come in the order of steps: a frame has the rows up to its own step.
  std::vector<std::int64_t> frame_begin{0};
  std::int64_t count = 0;
  add_row_parts(file, rows, parts, [&](std::span<const double> row) {
    while (frame_begin.size() <= frame_steps.size() &&
           row[0] > static_cast<double>(frame_steps[frame_begin.size() - 1]))
      frame_begin.push_back(count);
    ++count;
  });
  frame_begin.resize(frame_steps.size() + 1, count);
  file.add("contacts/frame_begin", frame_begin);
  file.add_attribute("contacts/frame_begin", "unit", "1");
  file.add_attribute("contacts/frame_begin", "description",
                     "frame k of /poses has the contacts frame_begin[k] to frame_begin[k + 1]");
}

RecordForces::RecordForces(const std::filesystem::path& record) : file_(record) {
  if (!file_.has("contacts")) return;
  begin_ = file_.read_ints("contacts/frame_begin");
  bool fits = !begin_.empty() && begin_.front() == 0 && std::ranges::is_sorted(begin_);
  for (const char* name : {"body_a", "body_b", "position", "normal", "force"}) {
    const Hdf5Shape shape = file_.shape(std::string("contacts/") + name);
    const bool is_number = std::string_view(name).starts_with("body");
    fits = fits && shape.size() == (is_number ? 1u : 2u) && (is_number || shape[1] == 3) &&
           shape[0] == static_cast<unsigned long long>(begin_.back());
  }
  if (!fits) file_.fail("the datasets of /contacts do not fit together");
}

std::vector<FrameContact> RecordForces::of_frame(size_t frame) const {
  if (frame >= frame_count()) file_.fail("has no contacts of frame " + std::to_string(frame));
  const auto first = static_cast<size_t>(begin_[frame]),
             count = static_cast<size_t>(begin_[frame + 1]) - first;
  if (count == 0) return {};
  const auto read = [&](const char* name) {
    return file_.read_rows(std::string("contacts/") + name, first, count);
  };
  const std::vector<double> body_a = read("body_a"), body_b = read("body_b"),
                            position = read("position"), normal = read("normal"),
                            force = read("force");
  const auto vector = [](const std::vector<double>& values, size_t c) {
    return Eigen::Vector3f(Vec3(values.data() + 3 * c).cast<float>());
  };
  std::vector<FrameContact> contacts;
  for (size_t c = 0; c < count; ++c)
    if (const Eigen::Vector3f on_b = vector(force, c); !on_b.isZero())
      contacts.push_back({static_cast<int>(body_a[c]), static_cast<int>(body_b[c]),
                          vector(position, c), vector(normal, c), on_b});
  return contacts;
}

namespace {

/// The polygons of a shape are what its hull makes of the vertices; where that drops one, the
/// stored triangles are taken as they are.
std::shared_ptr<const Polyhedron> shape_of(std::vector<Vec3> vertices,
                                           const std::vector<std::vector<int>>& triangles) {
  try {
    Polyhedron hull = convex_hull(vertices);
    if (hull.vertex_count() == static_cast<int>(vertices.size()))
      return std::make_shared<const Polyhedron>(std::move(hull));
  } catch (const InvalidPolyhedron&) {
  }
  return std::make_shared<const Polyhedron>(std::move(vertices), triangles, 1e-6);
}

std::vector<std::shared_ptr<const Polyhedron>> read_shapes(const Hdf5Reader& file,
                                                           const std::filesystem::path& path) {
  const std::vector<double> vertices = file.read_doubles("shapes/vertices");
  const std::vector<int> triangles = file.read_ints("shapes/triangles"),
                         vertex_begin = file.read_ints("shapes/vertex_begin"),
                         triangle_begin = file.read_ints("shapes/triangle_begin");
  const auto refuse = [&] {
    throw Error(path.string() + ": the datasets of /shapes do not fit together");
  };
  // Where each shape begins: from zero, ascending, to the end of entries that come three by three.
  const auto divides = [](const std::vector<int>& begin, size_t entries) {
    return !begin.empty() && begin.front() == 0 && std::is_sorted(begin.begin(), begin.end()) &&
           3 * static_cast<size_t>(begin.back()) == entries;
  };
  if (vertex_begin.size() != triangle_begin.size() || !divides(vertex_begin, vertices.size()) ||
      !divides(triangle_begin, triangles.size()))
    refuse();
  std::vector<std::shared_ptr<const Polyhedron>> shapes;
  for (size_t k = 0; k + 1 < vertex_begin.size(); ++k) {
    std::vector<Vec3> corners;
    for (int v = vertex_begin[k]; v < vertex_begin[k + 1]; ++v)
      corners.emplace_back(vertices.data() + 3 * static_cast<size_t>(v));
    std::vector<std::vector<int>> faces;
    for (int t = triangle_begin[k]; t < triangle_begin[k + 1]; ++t) {
      const int* corner = triangles.data() + 3 * static_cast<size_t>(t);
      faces.push_back({corner[0], corner[1], corner[2]});
    }
    try {
      shapes.push_back(shape_of(std::move(corners), faces));
    } catch (const InvalidPolyhedron& error) {
      throw Error(path.string() + ": shape " + std::to_string(k) + ": " + error.what());
    }
  }
  return shapes;
}

}  // namespace

MechanicalSystem read_record_system(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::vector<std::string> names = file.read_texts("bodies/name");
  const std::vector<double> mass = file.read_doubles("bodies/mass"),
                            volume = file.read_doubles("bodies/volume"),
                            inertia = file.read_doubles("bodies/inertia"),
                            normal = file.read_doubles("bodies/wall_normal");
  const std::vector<int> shape = file.read_ints("bodies/shape");
  const size_t count = names.size();
  if (mass.size() != count || volume.size() != count || shape.size() != count ||
      inertia.size() != 3 * count || normal.size() != 3 * count)
    throw Error(path.string() + ": the datasets of /bodies do not fit together");
  MechanicalSystem system;
  system.shapes = read_shapes(file, path);
  for (size_t b = 0; b < count; ++b) {
    RigidBody body;
    body.name = names[b];
    body.mass = mass[b];
    body.volume = volume[b];
    body.inertia = Vec3(inertia.data() + 3 * b);
    body.shape.plane.normal = Vec3(normal.data() + 3 * b);
    if (shape[b] >= static_cast<int>(system.shapes.size()))
      throw Error(path.string() + ": bodies/shape[" + std::to_string(b) + "] names no shape");
    if (shape[b] >= 0) {
      body.shape.polyhedron = system.shapes[static_cast<size_t>(shape[b])].get();
      if (static_cast<int>(b) != system.grain_count++)
        throw Error(path.string() + ": /bodies has a wall before a grain");
    }
    system.bodies.push_back(std::move(body));
  }
  return system;
}

}  // namespace ballast
