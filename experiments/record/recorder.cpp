#include "experiments/record/recorder.hpp"

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/row_log.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace fs = std::filesystem;

namespace {

// The places of the logs, and of the records made from them, in the folder of a run.
fs::path steps_log(const fs::path& folder) { return folder / "log" / "steps.bin"; }
fs::path poses_log(const fs::path& folder) { return folder / "log" / "poses.bin"; }
fs::path forces_log(const fs::path& folder) { return folder / "log" / "forces.bin"; }
fs::path record_file(const fs::path& folder) { return folder / "record.h5"; }
fs::path steps_table(const fs::path& folder) { return folder / "steps.csv"; }

std::uint64_t add_bits(std::uint64_t hash, const Vec3& value) {
  return fnv1a({reinterpret_cast<const char*>(value.data()), 3 * sizeof(double)}, hash);
}

/// A key of the names, masses and shapes of a system.
std::uint64_t system_key(const MechanicalSystem& system) {
  std::uint64_t hash = fnv1a(std::to_string(system.bodies.size()));
  for (const RigidBody& body : system.bodies) {
    hash = fnv1a(body.name, hash);
    hash = add_bits(hash, Vec3(body.mass, body.volume, 0.0));
    hash = add_bits(hash, body.inertia);
    if (body.is_wall())
      hash = add_bits(hash, body.shape.plane.normal);
    else
      for (const ConvexPart& part : convex_parts(body.shape))
        for (const Vec3& vertex : part.polyhedron->vertices()) hash = add_bits(hash, vertex);
  }
  return hash;
}

/// A log's header names its system and columns, so that the log of another program or scene is
/// refused and not misread.
RowLogHeader header_of(const RowLayout& layout, const MechanicalSystem& system) {
  RowLogHeader header{layout.group, system_key(system), layout.row_size()};
  for (const RowPart& part : layout.parts) header.text += ' ' + part.name;
  return header;
}

/// Opens a log to continue it. Throws Error unless it has this system and these columns.
RowReader open_log(const fs::path& file, const RowLogHeader& expected) {
  RowReader reader(file);
  if (reader.header().text != expected.text || reader.header().row_size != expected.row_size)
    throw Error(file.string() + ": has other columns than this program writes");
  if (reader.header().owner != expected.owner)
    throw Error(file.string() + ": belongs to another system of bodies");
  return reader;
}

/// Begins a log, or cuts one back to the checkpoint of `last_step`, as later rows will be made
/// again. Each row of the log of steps is a step; rows of frames and contacts begin with theirs.
RowWriter begin_or_continue(const fs::path& file, const RowLayout& layout,
                            const MechanicalSystem& system, long last_step) {
  const RowLogHeader header = header_of(layout, system);
  if (last_step == 0) return RowWriter(file, header);
  RowReader reader = open_log(file, header);
  const bool is_steps = layout.group == "steps";
  long kept = 0;
  for (auto row = reader.next(); !row.empty(); row = reader.next()) {
    if (is_steps ? kept == last_step : row[0] > static_cast<double>(last_step)) break;
    ++kept;
  }
  if (is_steps && kept < last_step)
    throw Error(file.string() + ": has " + std::to_string(kept) +
                " steps, the checkpoint is at step " + std::to_string(last_step));
  return RowWriter(file, reader, kept);
}

}  // namespace

Recorder::Recorder(const fs::path& folder, const MechanicalSystem& system, long last_step,
                   bool with_forces)
    : folder_(folder), system_(system) {
  create_folder(folder / "log");
  steps_.emplace(begin_or_continue(steps_log(folder), steps_layout(), system, last_step));
  poses_.emplace(
      begin_or_continue(poses_log(folder), poses_layout(system.bodies.size()), system, last_step));
  if (with_forces)
    forces_.emplace(begin_or_continue(forces_log(folder), contacts_layout(), system, last_step));
  for (const fs::path& file : {record_file(folder), steps_table(folder)}) {
    std::error_code error;
    fs::remove(file, error);
    if (error) throw Error(file.string() + ": cannot remove: " + error.message());
  }
}

void Recorder::add_step(const StepRecord& record) {
  row_.clear();
  for (const StepColumn& column : step_columns()) row_.push_back(record.*column.value);
  steps_->append(row_);
}

void Recorder::add_frame(const MotionState& state, const StepMemory& memory, double h) {
  pack_pose_row(state, row_);
  poses_->append(row_);
  // Contacts that exist before the first step belong to no step of this run.
  if (!forces_ || state.step == 0) return;
  for (size_t c = 0; c < memory.contacts.size(); ++c) {
    const ContactPoint& contact = memory.contacts[c];
    const Vec3 &p = contact.position, &n = contact.normal, force = memory.impulses[c] / h;
    row_ = {static_cast<double>(state.step), state.time};
    row_.insert(row_.end(),
                {static_cast<double>(contact.body_a), static_cast<double>(contact.body_b), p.x(),
                 p.y(), p.z(), n.x(), n.y(), n.z(), contact.gap, force.x(), force.y(), force.z()});
    forces_->append(row_);
  }
}

void Recorder::flush() {
  for (std::optional<RowWriter>* log : {&steps_, &poses_, &forces_})
    if (*log) (*log)->flush();
}

void Recorder::finish(const std::string& scene_text, const std::string& manifest_text) {
  flush();
  write_steps_csv(steps_table(folder_), read_steps(folder_));
  write_record_file(record_file(folder_), system_, steps_log(folder_), poses_log(folder_),
                    forces_ ? forces_log(folder_) : fs::path(), scene_text, manifest_text);
}

std::vector<StepRecord> read_steps(const fs::path& folder) {
  if (path_exists(record_file(folder))) return read_record_steps(record_file(folder));
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

std::vector<MotionState> read_poses(const fs::path& folder) {
  if (path_exists(record_file(folder))) return read_record_poses(record_file(folder));
  RowReader rows(poses_log(folder));
  std::vector<MotionState> frames;
  for (auto row = rows.next(); !row.empty(); row = rows.next())
    frames.push_back(unpack_pose_row(row));
  return frames;
}

void require_same_bodies(const fs::path& folder, const MechanicalSystem& system) {
  if (path_exists(steps_log(folder)))
    open_log(steps_log(folder), header_of(steps_layout(), system));
}

}  // namespace ballast
