#include "experiments/record/force_log.hpp"

#include <algorithm>

#include "experiments/record/row_parts.hpp"

namespace ballast {

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

}  // namespace ballast
