#include "experiments/record/record_file.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "geometry/shape/convex_hull.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace {

void describe(Hdf5Writer& file, const std::string& dataset, const char* unit,
              const char* description) {
  file.add_attribute(dataset, "unit", unit);
  file.add_attribute(dataset, "description", description);
}

/// Visits the numbers of all bodies in the order of a row, both to pack and to unpack.
template <class State, class Carry>
void carry_bodies(State& state, Carry&& carry) {
  for (auto& pose : state.pose)
    for (auto& x : pose.position) carry(x);
  for (auto& pose : state.pose) {
    auto& q = pose.rotation;
    carry(q.w()), carry(q.x()), carry(q.y()), carry(q.z());
  }
  for (auto* vectors : {&state.velocity, &state.spin})
    for (auto& vector : *vectors)
      for (auto& x : vector) carry(x);
}

/// Bodies and shapes as the datasets of record.h5.
struct SystemTables {
  std::vector<std::string> name;
  std::vector<double> mass, volume, inertia, wall_normal, vertices, part_position, part_rotation;
  std::vector<std::int32_t> shape, triangles, vertex_begin{0}, triangle_begin{0}, part_body,
      part_shape;

  /// Calls with(dataset, values, numbers per row, unit, description) for all tables but the names.
  template <class With>
  void each(With&& with) {
    with("bodies/mass", mass, 1, "kg", "mass; of a driven wall: the wall's");
    with("bodies/volume", volume, 1, "m^3", "volume; 0 for walls");
    with("bodies/inertia", inertia, 3, "kg m^2", "principal moments of inertia");
    with("bodies/wall_normal", wall_normal, 3, "1", "body frame, into the free side; 0 for grains");
    with("bodies/shape", shape, 1, "1",
         "number of the shape in /shapes; -1 for walls; of a body of parts their hull");
    // All shapes share four datasets: with a group for each shape HDF5 took 20 MB for 1200 of them.
    with("shapes/vertices", vertices, 3, "m", "body frame; shape after shape");
    with("shapes/triangles", triangles, 3, "1",
         "numbers of vertices within the shape, counter-clockwise from outside");
    with("shapes/vertex_begin", vertex_begin, 1, "1",
         "shape k has the vertices vertex_begin[k] to vertex_begin[k + 1]");
    with("shapes/triangle_begin", triangle_begin, 1, "1",
         "shape k has the triangles triangle_begin[k] to triangle_begin[k + 1]");
  }

  /// The same for the parts of bodies that have some; a record without parts has no group for them.
  template <class With>
  void each_of_parts(With&& with) {
    with("parts/body", part_body, 1, "1", "number of the body that the part belongs to");
    with("parts/shape", part_shape, 1, "1", "number of its shape in /shapes");
    with("parts/position", part_position, 3, "m", "of the shape's frame, in the body frame");
    with("parts/rotation", part_rotation, 4, "1",
         "unit quaternion w x y z: from the shape's frame to the body frame");
  }
};

void add_system(Hdf5Writer& file, const MechanicalSystem& system) {
  SystemTables tables;
  std::map<const Polyhedron*, std::int32_t> shape_index;
  for (const auto& pointer : system.shapes) {
    const Polyhedron& shape = *pointer;
    const auto number = static_cast<std::int32_t>(shape_index.size());
    if (!shape_index.emplace(&shape, number).second) continue;  // shared by several bodies
    for (const Vec3& vertex : shape.vertices())
      tables.vertices.insert(tables.vertices.end(), vertex.begin(), vertex.end());
    for (int f = 0; f < shape.face_count(); ++f) {
      // a polygon becomes a fan of triangles
      const auto loop = shape.face(f);
      for (size_t i = 2; i < loop.size(); ++i)
        tables.triangles.insert(tables.triangles.end(), {loop[0], loop[i - 1], loop[i]});
    }
    tables.vertex_begin.push_back(static_cast<std::int32_t>(tables.vertices.size() / 3));
    tables.triangle_begin.push_back(static_cast<std::int32_t>(tables.triangles.size() / 3));
  }
  for (const RigidBody& body : system.bodies) {
    tables.name.push_back(body.name);
    tables.mass.push_back(body.mass);
    tables.volume.push_back(body.volume);
    tables.inertia.insert(tables.inertia.end(), body.inertia.begin(), body.inertia.end());
    const Vec3 normal = body.is_wall() ? body.shape.plane.normal : Vec3::Zero();
    tables.wall_normal.insert(tables.wall_normal.end(), normal.begin(), normal.end());
    // bodies that share a shape name the same one
    tables.shape.push_back(body.is_wall() ? -1 : shape_index.at(body.shape.polyhedron));
    for (const ConvexPart& part : body.shape.parts) {
      tables.part_body.push_back(static_cast<std::int32_t>(tables.shape.size()) - 1);
      tables.part_shape.push_back(shape_index.at(part.polyhedron));
      const Vec3& p = part.pose.position;
      const Quat& q = part.pose.rotation;
      tables.part_position.insert(tables.part_position.end(), p.begin(), p.end());
      tables.part_rotation.insert(tables.part_rotation.end(), {q.w(), q.x(), q.y(), q.z()});
    }
  }
  file.add_group("bodies");
  file.add_group("shapes");
  file.add("bodies/name", tables.name);
  const auto add = [&](const char* name, const auto& values, size_t columns, const char* unit,
                       const char* description) {
    Hdf5Shape shape{values.size() / columns};
    if (columns > 1) shape.push_back(columns);
    file.add(name, values, shape);
    describe(file, name, unit, description);
  };
  tables.each(add);
  if (tables.part_body.empty()) return;
  file.add_group("parts");
  tables.each_of_parts(add);
}

/// `value` as a whole number from 0 to `most`. Throws Error, naming the dataset.
long whole(const Hdf5Reader& file, const char* dataset, double value, double most) {
  if (!(value >= 0.0 && value <= most))
    file.fail(std::string(dataset) + printed(" has %g, beyond 0 to %g", value, most));
  return static_cast<long>(value);
}
constexpr double most_steps = 0x1p53;

/// The number of rows that are gathered at once: a megabyte of numbers.
size_t rows_together(const RowLayout& layout) {
  // `| 1` makes the divisor odd, so never 0, whatever sizes a damaged file claims
  return std::max<size_t>(1, (1 << 17) / (layout.row_size() | 1));
}

/// Throws Error unless each dataset of the group has `rows` rows of the shape in the layout.
void require_rows(const Hdf5Reader& file, const RowLayout& layout, size_t rows) {
  for (const RowPart& part : layout.parts) {
    Hdf5Shape shape = part.shape;
    shape.insert(shape.begin(), rows);
    if (file.shape(layout.group + '/' + part.name) != shape)
      file.fail("the datasets of /" + layout.group + " do not fit together");
  }
}

/// The hulls of the vertices. The stored triangles are for other readers.
std::vector<std::shared_ptr<const Polyhedron>> shapes_of(const SystemTables& tables,
                                                         const Hdf5Reader& file) {
  const std::vector<std::int32_t>& begin = tables.vertex_begin;
  if (begin.empty() || begin.front() != 0 || !std::ranges::is_sorted(begin) ||
      3 * static_cast<size_t>(begin.back()) != tables.vertices.size())
    file.fail("the datasets of /shapes do not fit together");
  std::vector<std::shared_ptr<const Polyhedron>> shapes;
  for (size_t k = 0; k + 1 < begin.size(); ++k) {
    std::vector<Vec3> corners;
    for (int v = begin[k]; v < begin[k + 1]; ++v)
      corners.emplace_back(tables.vertices.data() + 3 * static_cast<size_t>(v));
    try {
      shapes.push_back(std::make_shared<const Polyhedron>(convex_hull(corners)));
    } catch (const InvalidPolyhedron& error) {
      file.fail("shape " + std::to_string(k) + ": " + error.what());
    }
  }
  return shapes;
}

void give_parts(const SystemTables& tables, const Hdf5Reader& file, MechanicalSystem& system) {
  for (size_t k = 0; k < tables.part_body.size(); ++k) {
    const int body = tables.part_body[k], shape = tables.part_shape[k];
    if (body < 0 || body >= system.grain_count || shape < 0 ||
        shape >= static_cast<int>(system.shapes.size()))
      file.fail("parts: number " + std::to_string(k) + " names no body or no shape");
    const double* q = tables.part_rotation.data() + 4 * k;
    const Pose pose{Vec3(tables.part_position.data() + 3 * k), Quat(q[0], q[1], q[2], q[3])};
    system.bodies[body].shape.parts.push_back({system.shapes[shape].get(), pose});
  }
}

}  // namespace

size_t RowPart::size() const {
  return std::accumulate(shape.begin(), shape.end(), size_t{1}, std::multiplies<>());
}

size_t RowLayout::row_size() const {
  size_t size = leading;
  for (const RowPart& part : parts) size += part.size();
  return size;
}

RowLayout steps_layout() {
  std::vector<RowPart> parts;
  for (const StepColumn& column : step_columns())
    parts.push_back({column.name, {}, column.unit, column.description});
  return {"steps", std::move(parts)};
}

RowLayout poses_layout(size_t bodies) {
  return {"poses",
          {{"step", {}, "1", "steps done at the frame", Hdf5Number::int64},
           {"time", {}, "s", "of the frame"},
           {"position", {bodies, 3}, "m", "centre of mass, world frame"},
           {"rotation",
            {bodies, 4},
            "1",
            "unit quaternion w x y z: from the body frame (principal axes) to the world frame"},
           {"velocity", {bodies, 3}, "m/s", "of the centre of mass, world frame"},
           {"spin", {bodies, 3}, "rad/s", "angular velocity, body frame"}}};
}

RowLayout contacts_layout() {
  constexpr size_t step_and_time = 2;
  using enum Hdf5Number;
  return {"contacts",
          {{"body_a", {}, "1", "number of the body in /bodies", int32},
           {"body_b", {}, "1", "number of the other body, to which the normal points", int32},
           {"position", {3}, "m", "world frame, midway between the two surfaces"},
           {"normal", {3}, "1", "unit, world frame, from a to b"},
           {"gap", {}, "m", "along the normal at detection; negative: overlap"},
           {"force", {3}, "N", "on body b, world frame: the step's impulse over its length"}},
          step_and_time};
}

void pack_pose_row(const MotionState& state, std::vector<double>& row) {
  row = {static_cast<double>(state.step), state.time};
  carry_bodies(state, [&](const double& number) { row.push_back(number); });
}

MotionState unpack_pose_row(std::span<const double> row) {
  const size_t bodies = (row.size() - 2) / 13;
  MotionState state{row[1], static_cast<long>(row[0]), std::vector<Pose>(bodies),
                    std::vector<Vec3>(bodies), std::vector<Vec3>(bodies)};
  auto next = row.begin() + 2;
  carry_bodies(state, [&](double& number) { number = *next++; });
  return state;
}

void add_rows(Hdf5Writer& file, const std::filesystem::path& log, const RowLayout& layout,
              const std::function<void(std::span<const double> row)>& see) {
  RowReader rows(log);
  const auto count = static_cast<size_t>(rows.safe_count());
  std::vector<Hdf5Id> datasets;
  file.add_group(layout.group);
  for (const RowPart& part : layout.parts) {
    const std::string name = layout.group + '/' + part.name;
    Hdf5Shape shape = part.shape;
    shape.insert(shape.begin(), count);
    datasets.push_back(file.add_rows(name, shape, part.number));
    describe(file, name, part.unit, part.description);
  }
  const size_t length = layout.row_size(), most_rows = rows_together(layout);
  std::vector<double> gathered, values;
  for (size_t first = 0; first < count; first += gathered.size() / length) {
    gathered.clear();
    for (size_t k = first; k < std::min(count, first + most_rows); ++k) {
      const std::span<const double> row = rows.next();
      gathered.insert(gathered.end(), row.begin(), row.end());
      if (see) see(row);
    }
    size_t begin = layout.leading;
    for (size_t p = 0; p < layout.parts.size(); ++p) {
      const size_t size = layout.parts[p].size();
      values.clear();
      for (size_t at = begin; at < gathered.size(); at += length)
        values.insert(values.end(), gathered.data() + at, gathered.data() + at + size);
      file.write_rows(datasets[p], first, values);
      begin += size;
    }
  }
}

void write_record_file(const std::filesystem::path& path, const MechanicalSystem& system,
                       const std::filesystem::path& steps, const std::filesystem::path& poses,
                       const std::filesystem::path& forces, const std::string& scene_text,
                       const std::string& manifest_text) {
  Hdf5Writer file(path, Hdf5Storage::compressed);
  file.add_attribute("/", "format", "ballast record 2");
  file.add_attribute("/", "bits_generation", std::to_string(bits_generation));
  file.add_attribute("/", "scene", scene_text);
  file.add_attribute("/", "manifest", manifest_text);
  add_rows(file, steps, steps_layout());
  std::vector<double> frame_steps;
  add_rows(file, poses, poses_layout(system.bodies.size()),
           [&](std::span<const double> row) { frame_steps.push_back(row[0]); });
  if (!forces.empty()) {
    // Rows and frames come in the order of steps: a frame has the rows up to its own step.
    std::vector<std::int64_t> begin{0};
    std::int64_t count = 0;
    add_rows(file, forces, contacts_layout(), [&](std::span<const double> row) {
      while (begin.size() <= frame_steps.size() && row[0] > frame_steps[begin.size() - 1])
        begin.push_back(count);
      ++count;
    });
    begin.resize(frame_steps.size() + 1, count);
    file.add("contacts/frame_begin", begin);
    describe(file, "contacts/frame_begin", "1",
             "frame k of /poses has the contacts frame_begin[k] to frame_begin[k + 1]");
  }
  add_system(file, system);
  file.commit();
}

std::vector<StepRecord> read_record_steps(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const std::vector<double> time = file.read<double>("steps/time");
  require_rows(file, steps_layout(), time.size());
  std::vector<StepRecord> steps(time.size());
  for (const StepColumn& column : step_columns()) {
    const std::vector<double> values = file.read<double>(std::string("steps/") + column.name);
    for (size_t k = 0; k < steps.size(); ++k) steps[k].*column.value = values[k];
  }
  return steps;
}

std::vector<MotionState> read_record_poses(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  const Hdf5Shape shape = file.shape("poses/position");
  const RowLayout layout = poses_layout(shape.size() == 3 ? shape[1] : 0);
  require_rows(file, layout, shape.empty() ? 0 : shape[0]);
  std::vector<MotionState> frames;
  size_t here = 0;
  for (size_t first = 0; first < shape[0]; first += here) {
    here = std::min<size_t>(rows_together(layout), shape[0] - first);
    std::vector<std::vector<double>> parts;
    for (const RowPart& part : layout.parts)
      parts.push_back(file.read_rows("poses/" + part.name, first, here));
    for (size_t k = 0; k < here; ++k) {
      // The row of a frame is put together as it was in the log, and then unpacked.
      std::vector<double> row;
      for (const std::vector<double>& values : parts) {
        const double* begin = values.data() + values.size() / here * k;
        row.insert(row.end(), begin, begin + values.size() / here);
      }
      whole(file, "poses/step", row[0], most_steps);
      frames.push_back(unpack_pose_row(row));
    }
  }
  return frames;
}

RecordForces::RecordForces(const std::filesystem::path& record) : file_(record) {
  if (!file_.has("contacts")) return;
  begin_ = file_.read<int>("contacts/frame_begin");
  if (begin_.empty() || begin_.front() != 0 || !std::ranges::is_sorted(begin_))
    file_.fail("contacts/frame_begin does not ascend from 0");
  require_rows(file_, contacts_layout(), static_cast<size_t>(begin_.back()));
}

std::vector<FrameContact> RecordForces::of_frame(size_t frame) const {
  if (frame >= frame_count()) file_.fail("has no contacts of frame " + std::to_string(frame));
  const size_t first = begin_[frame], count = begin_[frame + 1] - first;
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
  const Hdf5Shape bodies = file_.shape("bodies/mass");
  const double last_body = bodies.empty() ? -1.0 : static_cast<double>(bodies[0]) - 1.0;
  const auto body = [&](const char* dataset, double value) {
    return static_cast<int>(whole(file_, dataset, value, last_body));
  };
  std::vector<FrameContact> contacts;
  for (size_t c = 0; c < count; ++c)
    if (const Eigen::Vector3f on_b = vector(force, c); !on_b.isZero())
      contacts.push_back({body("contacts/body_a", body_a[c]), body("contacts/body_b", body_b[c]),
                          vector(position, c), vector(normal, c), on_b});
  return contacts;
}

MechanicalSystem read_record_system(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  SystemTables tables;
  tables.name = file.read_texts("bodies/name");
  const size_t count = tables.name.size();
  size_t rows = count;
  const auto read = [&](std::string_view name, auto& values, size_t columns, auto...) {
    values = file.read<typename std::decay_t<decltype(values)>::value_type>(name.data());
    if (name == "parts/body") rows = values.size();
    if (!name.starts_with("shapes") && values.size() != columns * rows)
      file.fail("the datasets of /" + std::string(name.substr(0, name.find('/'))) +
                " do not fit together");
  };
  tables.each(read);
  if (file.has("parts/body")) tables.each_of_parts(read);
  MechanicalSystem system;
  system.shapes = shapes_of(tables, file);
  for (size_t b = 0; b < count; ++b) {
    RigidBody body;
    body.name = tables.name[b];
    body.mass = tables.mass[b];
    body.volume = tables.volume[b];
    body.inertia = Vec3(tables.inertia.data() + 3 * b);
    body.shape.plane.normal = Vec3(tables.wall_normal.data() + 3 * b);
    if (tables.shape[b] < 0 && body.mass > 0.0) body.wall.motion = WallMotion::driven;
    const int shape = tables.shape[b];
    if (shape >= static_cast<int>(system.shapes.size()))
      file.fail("bodies/shape[" + std::to_string(b) + "] names no shape");
    if (shape >= 0) {
      body.shape.polyhedron = system.shapes[shape].get();
      if (static_cast<int>(b) != system.grain_count++)
        file.fail("/bodies has a wall before a grain");
    }
    system.bodies.push_back(std::move(body));
  }
  give_parts(tables, file, system);
  return system;
}

}  // namespace ballast
