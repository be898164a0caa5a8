#include "experiments/record/force_log.hpp"

#include <algorithm>

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
  std::vector<std::int64_t> frame_begin;
  std::vector<std::int32_t> body_a, body_b;
  std::vector<double> position, normal, gap, force;
  rows.rewind();
  std::span<const double> row = rows.next();
  // Rows and frames come in the order of steps: a frame has the rows up to its own step.
  for (const std::int64_t step : frame_steps) {
    frame_begin.push_back(static_cast<std::int64_t>(gap.size()));
    for (; !row.empty() && static_cast<std::int64_t>(row[0]) <= step; row = rows.next()) {
      body_a.push_back(static_cast<std::int32_t>(row[2]));
      body_b.push_back(static_cast<std::int32_t>(row[3]));
      position.insert(position.end(), row.begin() + 4, row.begin() + 7);
      normal.insert(normal.end(), row.begin() + 7, row.begin() + 10);
      gap.push_back(row[10]);
      force.insert(force.end(), row.begin() + 11, row.begin() + 14);
    }
  }
  frame_begin.push_back(static_cast<std::int64_t>(gap.size()));
  const size_t count = gap.size();
  const auto describe = [&](const char* name, const char* unit, const char* description) {
    file.add_attribute(name, "unit", unit);
    file.add_attribute(name, "description", description);
  };
  file.add_group("contacts");
  file.add("contacts/frame_begin", frame_begin);
  describe("contacts/frame_begin", "1",
           "frame k of /poses has the contacts frame_begin[k] to frame_begin[k + 1]");
  file.add("contacts/body_a", body_a);
  describe("contacts/body_a", "1", "number of the body in /bodies");
  file.add("contacts/body_b", body_b);
  describe("contacts/body_b", "1", "number of the other body, to which the normal points");
  file.add("contacts/position", position, {count, 3});
  describe("contacts/position", "m", "world frame, midway between the two surfaces");
  file.add("contacts/normal", normal, {count, 3});
  describe("contacts/normal", "1", "unit, world frame, from a to b");
  file.add("contacts/gap", gap);
  describe("contacts/gap", "m", "along the normal at detection; negative: overlap");
  file.add("contacts/force", force, {count, 3});
  describe("contacts/force", "N", "on body b, world frame: the step's impulse over its length");
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
