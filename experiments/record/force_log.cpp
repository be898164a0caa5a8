#include "experiments/record/force_log.hpp"

#include <algorithm>

#include "experiments/record/row_parts.hpp"
#include "platform/error.hpp"
#include "platform/hdf5_reader.hpp"

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

std::vector<std::vector<FrameContact>> read_record_forces(const std::filesystem::path& record) {
  const Hdf5Reader file(record);
  if (!file.has("contacts")) return {};
  const std::vector<int> begin = file.read_ints("contacts/frame_begin"),
                         body_a = file.read_ints("contacts/body_a"),
                         body_b = file.read_ints("contacts/body_b");
  const std::vector<double> position = file.read_doubles("contacts/position"),
                            normal = file.read_doubles("contacts/normal"),
                            force = file.read_doubles("contacts/force");
  const size_t count = body_a.size();
  if (begin.empty() || begin.front() != 0 || !std::is_sorted(begin.begin(), begin.end()) ||
      static_cast<size_t>(begin.back()) != count || body_b.size() != count ||
      position.size() != 3 * count || normal.size() != 3 * count || force.size() != 3 * count)
    throw Error(record.string() + ": the datasets of /contacts do not fit together");
  const auto vector = [](const std::vector<double>& values, size_t c) {
    return Eigen::Vector3f(Vec3(values.data() + 3 * c).cast<float>());
  };
  std::vector<std::vector<FrameContact>> frames(begin.size() - 1);
  for (size_t f = 0; f < frames.size(); ++f)
    for (auto c = static_cast<size_t>(begin[f]); c < static_cast<size_t>(begin[f + 1]); ++c)
      if (const Eigen::Vector3f on_b = vector(force, c); !on_b.isZero())
        frames[f].push_back({body_a[c], body_b[c], vector(position, c), vector(normal, c), on_b});
  return frames;
}

}  // namespace ballast
