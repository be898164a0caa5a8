#include "experiments/record/record_file.hpp"

#include <functional>
#include <limits>

#include "platform/hdf5_file.hpp"
#include "platform/program.hpp"
#include "tests/experiments/record/sample_record.hpp"
#include "tests/support/hdf5_attribute.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Row k has the numbers 10 k, 10 k + 1, ...
void write_log(const fs::path& path, long rows, size_t row_size) {
  RowWriter log(path, {"rows", 0, row_size});
  std::vector<double> row(row_size);
  for (long k = 0; k < rows; ++k) {
    for (size_t i = 0; i < row_size; ++i)
      row[i] = static_cast<double>(10 * k) + static_cast<double>(i);
    log.append(row);
  }
  log.flush();
}

/// A number in /proc/self/status, such as "VmRSS:" [kB].
long memory_entry(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word && word != name) {
  }
  long kilobytes = 0;
  status >> kilobytes;
  return kilobytes;
}

/// The amount by which `work` raises the peak of the resident memory of a child process [kB]. It is
/// 0 under sanitizers, which keep freed memory.
long peak_memory(const std::function<void()>& work) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  work();
  return 0;
#endif
  const ChildResult child = run_in_child(1e9, [&] {
    const long before = memory_entry("VmRSS:");
    work();
    return std::to_string(memory_entry("VmHWM:") - before);
  });
  REQUIRE(child.end == ChildEnd::complete);
  return std::stol(child.answer);
}

}  // namespace

TEST_CASE("record.h5 explains itself: units, bodies, shapes, scene and manifest") {
  OpenRecord open(10);
  const MechanicalSystem& system = open.system;
  const std::string scene(100000, 's'),
      manifest = "{\"µ\": 1}";  // the scene is longer than a compact attribute may be
  open.recorder.finish(scene, manifest);
  const fs::path path = open.path() / "record.h5";
  const Hdf5Reader file(path);
  CHECK(hdf5_attribute(path, "/", "scene") == scene);
  CHECK(hdf5_attribute(path, "/", "manifest") == manifest);
  CHECK(hdf5_attribute(path, "/", "bits_generation") == std::to_string(bits_generation));
  for (const StepColumn& column : step_columns()) {
    const std::string name = std::string("steps/") + column.name;
    CHECK(hdf5_attribute(path, name, "unit") == column.unit);
    CHECK(hdf5_attribute(path, name, "description") == column.description);
  }
  CHECK(file.shape("poses/position") == Hdf5Shape{3, 9, 3});
  CHECK(file.shape("poses/rotation") == Hdf5Shape{3, 9, 4});
  CHECK(file.read<double>("poses/step") == std::vector<double>{0, 5, 10});
  CHECK(hdf5_attribute(path, "poses/spin", "unit") == "rad/s");
  const auto names = file.read_texts("bodies/name");
  CHECK((names.size() == 9 && names[1] == "grain 1" && names[6] == "x_max"));
  CHECK(file.read<double>("bodies/shape") == std::vector<double>{0, 1, 1, -1, -1, -1, -1, -1, -1});
  CHECK(file.read<double>("bodies/mass")[2] == system.bodies[2].mass);
  CHECK(file.read<double>("bodies/volume")[0] == system.bodies[0].volume);
  CHECK(file.read<double>("bodies/inertia")[4] == system.bodies[1].inertia.y());
  CHECK(file.read<double>("bodies/wall_normal")[3 * 6] == -1.0);
  const auto vertices = file.read<double>("shapes/vertices"),
             triangles = file.read<double>("shapes/triangles");
  const auto vertex_begin = file.read<double>("shapes/vertex_begin"),
             triangle_begin = file.read<double>("shapes/triangle_begin");
  REQUIRE((vertex_begin.size() == 3 && triangle_begin.size() == 3));
  REQUIRE(file.shape("shapes/vertices") == Hdf5Shape{static_cast<size_t>(vertex_begin[2]), 3});
  REQUIRE(file.shape("shapes/triangles") == Hdf5Shape{static_cast<size_t>(triangle_begin[2]), 3});
  for (int k = 0; k < 2; ++k) {
    CHECK(vertex_begin[k + 1] - vertex_begin[k] == system.shapes[k]->vertex_count());
    // Computes the volume by the divergence theorem, which is right only if vertices, triangles and
    // their orientation are.
    double volume = 0.0;
    for (size_t t = 3 * static_cast<size_t>(triangle_begin[k]);
         t < 3 * static_cast<size_t>(triangle_begin[k + 1]); t += 3) {
      const auto vertex = [&](size_t i) {
        return Vec3(vertices.data() + 3 * static_cast<size_t>(vertex_begin[k] + triangles[t + i]));
      };
      volume += vertex(0).dot(vertex(1).cross(vertex(2))) / 6.0;
    }
    CHECK(volume == Approx(system.bodies[k].volume).epsilon(1e-12));
  }
}

TEST_CASE("a broken record.h5 is an error that names it") {
  OpenRecord open(300);
  open.recorder.finish("", "");
  const fs::path file = open.path() / "record.h5";
  const std::string whole = file_bytes(file);
  for (size_t part = 0; part < 40; ++part) {
    put_bytes(file, std::string_view(whole).substr(0, whole.size() * part / 40));
    CHECK_THAT(run_error([&] { read_steps(open.path()); }), Contains(file.string()));
    CHECK_THAT(run_error([&] { read_poses(open.path()); }), Contains(file.string()));
  }
}

TEST_CASE("bodies, walls and shapes come back from the record with their bits") {
  OpenRecord open(5);
  open.recorder.finish("", "");
  const MechanicalSystem& system = open.system;
  const MechanicalSystem read = read_record_system(open.path() / "record.h5");
  CHECK(read.grain_count == system.grain_count);
  REQUIRE(read.bodies.size() == system.bodies.size());
  REQUIRE(read.shapes.size() == system.shapes.size());
  for (size_t b = 0; b < read.bodies.size(); ++b) {
    const RigidBody &body = read.bodies[b], &expected = system.bodies[b];
    CHECK(body.name == expected.name);
    CHECK(same_bits(body.mass, expected.mass));
    CHECK(same_bits(body.volume, expected.volume));
    CHECK(same_bits(body.inertia, expected.inertia));
    REQUIRE(body.is_wall() == expected.is_wall());
    if (body.is_wall()) {
      CHECK(same_bits(body.shape.plane.normal, expected.shape.plane.normal));
      continue;
    }
    const Polyhedron &shape = *body.shape.polyhedron, &known = *expected.shape.polyhedron;
    REQUIRE(shape.vertex_count() == known.vertex_count());
    for (int v = 0; v < shape.vertex_count(); ++v)
      CHECK(same_bits(shape.vertex(v), known.vertex(v)));
    CHECK(shape.face_count() == known.face_count());
  }
  CHECK(read.bodies[1].shape.polyhedron == read.bodies[2].shape.polyhedron);
}

TEST_CASE("a record whose datasets do not fit together is refused") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "record.h5";
  Hdf5Writer writer(file, Hdf5Storage::plain);
  writer.add_group("bodies");
  writer.add("bodies/name", std::vector<std::string>{"a", "b"});
  for (const char* name : {"mass", "volume"})
    writer.add(std::string("bodies/") + name, std::vector<double>{1.0});
  for (const char* name : {"inertia", "wall_normal"})
    writer.add(std::string("bodies/") + name, std::vector<double>(6, 1.0));
  writer.add("bodies/shape", std::vector<std::int32_t>{0, 0});
  writer.commit();
  CHECK_THAT(run_error([&] { read_record_system(file); }), Contains("/bodies do not fit together"));
  CHECK_THAT(run_error([&] { read_record_system(folder.path() / "none.h5"); }),
             Contains("no such file"));
}

TEST_CASE("a number of steps that no run has is refused") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "record.h5";
  for (const auto step : {std::numeric_limits<std::int64_t>::max(), std::int64_t{-1}}) {
    Hdf5Writer writer(file, Hdf5Storage::plain);
    writer.add_group("poses");
    writer.add("poses/step", std::vector<std::int64_t>{step});
    writer.add("poses/time", std::vector<double>{0.0});
    for (const char* name : {"position", "velocity", "spin"})
      writer.add(std::string("poses/") + name, std::vector<double>(3), {1, 1, 3});
    writer.add("poses/rotation", std::vector<double>{1, 0, 0, 0}, {1, 1, 4});
    writer.commit();
    CHECK_THAT(run_error([&] { read_record_poses(file); }), Contains("poses/step has"));
  }
}

TEST_CASE("a contact of a body that is not there is refused") {
  OpenRecord open(5, true);
  StepMemory memory = sample_memory(1);
  memory.contacts[0].body_b = 1000;
  open.recorder.add_frame(sample_state(open.system, 10), memory, sample_step);
  open.recorder.finish("", "");
  const RecordForces forces(open.path() / "record.h5");
  CHECK(forces.of_frame(1).size() == 1);
  CHECK_THAT(run_error([&] { forces.of_frame(2); }), Contains("contacts/body_b has 1000"));
}

TEST_CASE("quantities of rows become datasets, more rows than are gathered at once") {
  const TemporaryFolder folder;
  const fs::path log = folder.path() / "rows", record = folder.path() / "a.h5";
  constexpr long rows = 50000;  // 48 bytes each: more than two megabytes
  write_log(log, rows, 6);
  Hdf5Writer writer(record, Hdf5Storage::compressed);
  const RowLayout layout{
      "all", {{"square", {2, 2}, "m", "four"}, {"last", {}, "1", "one", Hdf5Number::int32}}, 1};
  long seen = 0;
  bool in_order = true;
  add_rows(writer, log, layout, [&](std::span<const double> row) {
    in_order = in_order && row[0] == static_cast<double>(10 * seen++);
  });
  writer.commit();
  CHECK((seen == rows && in_order));
  const Hdf5Reader file(record);
  CHECK(file.shape("all/last") == Hdf5Shape{rows});
  CHECK(file.shape("all/square") == Hdf5Shape{rows, 2, 2});
  CHECK(hdf5_attribute(record, "all/square", "unit") == "m");
  CHECK(hdf5_attribute(record, "all/last", "description") == "one");
  const std::vector<double> square = file.read<double>("all/square");
  const std::vector<int> last = file.read<int>("all/last");
  bool fits = true;
  for (size_t k = 0; k < rows; ++k) {
    const double first = 10.0 * static_cast<double>(k);
    fits = fits && last[k] == static_cast<int>(first) + 5;
    for (size_t i = 0; i < 4; ++i)
      fits = fits && square[4 * k + i] == first + 1 + static_cast<double>(i);
  }
  CHECK(fits);
  // Rows that are longer than the buffer, and no rows at all.
  for (const long count : {0L, 3L}) {
    write_log(log, count, 200000);
    Hdf5Writer other(record, Hdf5Storage::compressed);
    add_rows(other, log, {"rows", {{"all", {100000, 2}}}});
    other.commit();
    const std::vector<double> all = Hdf5Reader(record).read<double>("rows/all");
    REQUIRE(all.size() == static_cast<size_t>(count) * 200000);
    if (count > 0) CHECK(all.back() == 20.0 + 199999.0);
  }
}

TEST_CASE("a record takes the same memory however long its run was") {
  const MechanicalSystem system = sample_system();
  StepMemory memory;
  for (int c = 0; c < 2000; ++c) {
    const double x = std::sin(c);
    memory.contacts.push_back({c, c + 1, 7, Vec3(0, 0, 1), Vec3(x, -x, 2 * x), -1e-6 * x});
    memory.impulses.emplace_back(x, 0.5, x);
  }
  // The peak at the end of a run of this number of frames.
  const auto peak_after = [&](long frames) {
    const TemporaryFolder folder;
    Recorder recorder(folder.path(), system, 0, true);
    for (long step = 1; step <= frames; ++step) {
      const MotionState state = sample_state(system, step);
      recorder.add_step(sample_row(step));
      recorder.add_frame(state, memory, 1e-4);
    }
    return peak_memory([&] { recorder.finish("", ""); });
  };
  // 4 MB of contacts, and 27 MB.
  CHECK(peak_after(120) < peak_after(20) + 5000);
}

TEST_CASE("record.h5 has the contacts and forces of every stored frame, where they are asked for") {
  OpenRecord open(20, true);
  // One more frame, with a contact without force.
  StepMemory memory = sample_memory(2);
  memory.impulses[0] = Vec3::Zero();
  const MotionState state = sample_state(open.system, 25);
  open.recorder.add_frame(state, memory, sample_step);
  open.recorder.finish("", "");
  const fs::path record = open.path() / "record.h5";
  const Hdf5Reader file(record);
  // Steps 0 (none: before the first step), 5, 10, 15, 20, 25 have 0, 1, 2, 3, 0, 2 contacts.
  CHECK(file.read<int>("contacts/frame_begin") == std::vector<int>{0, 0, 1, 3, 6, 6, 8});
  CHECK(file.read<int>("contacts/body_a") == std::vector<int>{0, 0, 1, 0, 1, 2, 0, 1});
  CHECK(file.read<int>("contacts/body_b") == std::vector<int>{1, 1, 2, 1, 2, 3, 1, 2});
  const double x = 15 + 0.1 * 2;
  CHECK(same_bits(file.read<double>("contacts/force")[17], x * sample_step / sample_step));
  CHECK(same_bits(file.read<double>("contacts/position")[15], x));
  CHECK(same_bits(file.read<double>("contacts/gap")[5], -1e-6 * x));
  CHECK(file.read<double>("contacts/normal")[17] == 1.0);
  CHECK(hdf5_attribute(record, "contacts/force", "unit") == "N");
  CHECK_FALSE(hdf5_attribute(record, "contacts/gap", "description").empty());

  // Reading leaves contacts without force out.
  const RecordForces forces(record);
  REQUIRE(forces.frame_count() == 6);
  for (size_t k = 0; k < 6; ++k)
    CHECK(forces.of_frame(k).size() == std::vector<size_t>{0, 1, 2, 3, 0, 1}[k]);
  const FrameContact last = forces.of_frame(3)[2];
  CHECK((last.body_a == 2 && last.body_b == 3));
  CHECK(last.position == Eigen::Vector3f(15.2f, -15.2f, 30.4f));
  CHECK(last.normal == Eigen::Vector3f::UnitZ());
  CHECK_THAT(last.force.z(), Catch::Matchers::WithinRel(15.2f, 1e-6f));
  CHECK_THAT(run_error([&] { forces.of_frame(6); }), Contains("has no contacts of frame 6"));

  OpenRecord without(10);
  without.recorder.finish("", "");
  CHECK_FALSE(fs::exists(without.path() / "log" / "forces.bin"));
  CHECK_FALSE(Hdf5Reader(without.path() / "record.h5").has("contacts"));
  CHECK(RecordForces(without.path() / "record.h5").frame_count() == 0);
}
