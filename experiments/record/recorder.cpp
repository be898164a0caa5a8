#include "experiments/record/recorder.hpp"

#include <optional>

#include "experiments/record/record_file.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "platform/row_log.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

// Where the logs and the records made of them are in a run's folder.
fs::path steps_log(const fs::path& folder) { return folder / "log" / "steps.bin"; }
fs::path poses_log(const fs::path& folder) { return folder / "log" / "poses.bin"; }
fs::path forces_log(const fs::path& folder) { return folder / "log" / "forces.bin"; }
fs::path record_file(const fs::path& folder) { return folder / "record.h5"; }
fs::path steps_table(const fs::path& folder) { return folder / "steps.csv"; }

std::uint64_t add_bits(std::uint64_t hash, const Vec3& value) {
  return fnv1a({reinterpret_cast<const char*>(value.data()), 3 * sizeof(double)}, hash);
}

/// Of what a system is made of: names, masses, shapes.
std::uint64_t system_key(const MechanicalSystem& system) {
  std::uint64_t hash = fnv1a(std::to_string(system.bodies.size()));
  for (const RigidBody& body : system.bodies) {
    hash = fnv1a(body.name, hash);
    hash = add_bits(hash, Vec3(body.mass, body.volume, 0.0));
    hash = add_bits(hash, body.inertia);
    if (body.is_wall())
      hash = add_bits(hash, body.shape.plane.normal);
    else
      for (const Vec3& vertex : body.shape.polyhedron->vertices()) hash = add_bits(hash, vertex);
  }
  return hash;
}

/// The log of steps belongs to this system and has these columns: another program's or another
/// scene's log is then refused, not misread.
RowLogHeader steps_header(const MechanicalSystem& system) {
  RowLogHeader header{"steps", system_key(system), step_columns().size()};
  for (const StepColumn& column : step_columns()) header.text += std::string(" ") + column.name;
  return header;
}

RowLogHeader poses_header(const MechanicalSystem& system) {
  const size_t bodies = system.bodies.size();
  return {"poses " + std::to_string(bodies) + " bodies: step time position rotation velocity spin",
          system_key(system), pose_row_size(bodies)};
}

RowLogHeader forces_header(const MechanicalSystem& system) {
  return {"forces: step time body_a body_b position normal gap force", system_key(system),
          force_row_size};
}

/// Opens a log that is to be continued: of this system, with these columns.
RowReader open_log(const fs::path& file, const RowLogHeader& expected) {
  RowReader reader(file);
  if (reader.header().text != expected.text || reader.header().row_size != expected.row_size)
    throw Error(file.string() + ": has other columns than this program writes");
  if (reader.header().owner != expected.owner)
    throw Error(file.string() + ": belongs to another system of bodies");
  return reader;
}

/// Row k is step k + 1.
RowWriter continue_steps(const fs::path& file, const RowLogHeader& header, long last_step) {
  RowReader reader = open_log(file, header);
  for (long k = 0; k < last_step; ++k)
    if (reader.next().empty())
      throw Error(file.string() + ": has " + std::to_string(k) +
                  " steps, the checkpoint is at step " + std::to_string(last_step));
  return RowWriter(file, reader, last_step);
}

/// Keeps the rows up to the checkpoint, of frames or of their contacts: those after it will be made
/// again.
RowWriter continue_frames(const fs::path& file, const RowLogHeader& header, long last_step) {
  RowReader reader = open_log(file, header);
  long kept = 0;
  for (auto row = reader.next(); !row.empty() && row[0] <= static_cast<double>(last_step);
       row = reader.next())
    ++kept;
  return RowWriter(file, reader, kept);
}

/// steps.csv: 17 digits bring back the same bits.
void write_table(const fs::path& target, RowReader& rows) {
  AtomicFile file(target);
  CsvWriter csv;
  for (const StepColumn& column : step_columns()) csv.add(column.name);
  csv.end_row();
  rows.rewind();
  for (auto row = rows.next(); !row.empty(); row = rows.next()) {
    for (const double value : row) csv.add(value, 17);
    csv.end_row();
    file.write(csv.take());
  }
  file.write(csv.take());  // where there is no row
  file.commit();
}

/// A record of earlier steps is not one of this run any more.
void remove_stale(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw Error(file.string() + ": cannot remove: " + error.message());
}

}  // namespace

struct Recorder::Impl {
  fs::path folder;
  const MechanicalSystem& system;
  std::optional<RowWriter> steps, poses, forces;
  std::vector<double> row;
};

Recorder::Recorder(const fs::path& folder, const MechanicalSystem& system, long last_step,
                   bool with_forces)
    : impl_(new Impl{folder, system, {}, {}, {}, {}}) {
  create_folder(folder / "log");
  const RowLogHeader of_steps = steps_header(system), of_poses = poses_header(system);
  // a resumed run cuts its logs back to the checkpoint; a fresh one begins them anew
  if (last_step > 0) {
    impl_->steps.emplace(continue_steps(steps_log(folder), of_steps, last_step));
    impl_->poses.emplace(continue_frames(poses_log(folder), of_poses, last_step));
  } else {
    impl_->steps.emplace(steps_log(folder), of_steps);
    impl_->poses.emplace(poses_log(folder), of_poses);
  }
  if (with_forces && last_step > 0)
    impl_->forces.emplace(continue_frames(forces_log(folder), forces_header(system), last_step));
  else if (with_forces)
    impl_->forces.emplace(forces_log(folder), forces_header(system));
  remove_stale(record_file(folder));
  remove_stale(steps_table(folder));
}

Recorder::~Recorder() = default;

void Recorder::add_step(const StepRecord& record) {
  impl_->row.clear();
  for (const StepColumn& column : step_columns()) impl_->row.push_back(record.*column.value);
  impl_->steps->append(impl_->row);
}

void Recorder::add_poses(const MotionState& state) {
  pack_pose_row(state, impl_->row);
  impl_->poses->append(impl_->row);
}

void Recorder::add_forces(const MotionState& state, const StepMemory& memory, double h) {
  // What is there before the first step belongs to no step of this run.
  if (!impl_->forces || state.step == 0) return;
  for (size_t c = 0; c < memory.contacts.size(); ++c) {
    pack_force_row(state, memory.contacts[c], memory.impulses[c], h, impl_->row);
    impl_->forces->append(impl_->row);
  }
}

void Recorder::flush() {
  impl_->steps->flush();
  impl_->poses->flush();
  if (impl_->forces) impl_->forces->flush();
}

void Recorder::finish(const std::string& scene_text, const std::string& manifest_text) {
  flush();
  const fs::path& folder = impl_->folder;
  RowReader steps(steps_log(folder)), poses(poses_log(folder));
  write_table(steps_table(folder), steps);
  std::optional<RowReader> forces;
  if (impl_->forces) forces.emplace(forces_log(folder));
  write_record_file(record_file(folder), impl_->system, steps, poses, forces ? &*forces : nullptr,
                    scene_text, manifest_text);
}

std::vector<StepRecord> read_steps(const fs::path& folder) {
  if (is_there(record_file(folder))) return read_record_steps(record_file(folder));
  RowReader rows(steps_log(folder));
  if (rows.header().row_size != step_columns().size())
    throw Error(steps_log(folder).string() + ": has other columns than this program reads");
  std::vector<StepRecord> steps;
  for (auto row = rows.next(); !row.empty(); row = rows.next()) {
    steps.emplace_back();
    for (size_t c = 0; c < row.size(); ++c) steps.back().*step_columns()[c].value = row[c];
  }
  return steps;
}

std::vector<PoseFrame> read_poses(const fs::path& folder) {
  if (is_there(record_file(folder))) return read_record_poses(record_file(folder));
  RowReader rows(poses_log(folder));
  std::vector<PoseFrame> frames;
  for (auto row = rows.next(); !row.empty(); row = rows.next())
    frames.push_back(unpack_pose_row(row));
  return frames;
}

void require_same_bodies(const fs::path& folder, const MechanicalSystem& system) {
  if (is_there(steps_log(folder))) open_log(steps_log(folder), steps_header(system));
}

}  // namespace ballast
