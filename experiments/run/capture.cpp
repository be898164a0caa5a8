#include "experiments/run/capture.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "experiments/measure/wall_cycles.hpp"
#include "platform/atomic_file.hpp"
#include "platform/text.hpp"

namespace ballast {

CaptureSettings CaptureSettings::parse(std::string_view text) {
  CaptureSettings settings;
  if (text.empty()) return settings;
  settings.steps = 0;
  settings.to = 1L << 60;
  bool has_range = false;
  const std::map<std::string, long*> places{{"every", &settings.every},
                                            {"steps", &settings.steps},
                                            {"from", &settings.from},
                                            {"to", &settings.to},
                                            {"also", &settings.also}};
  for (const std::string& item : split(text, ',')) {
    const std::string name = item.substr(0, item.find('='));
    const auto place = places.find(name);
    if (place == places.end())
      throw std::invalid_argument("'" + item + "': expected every=, steps=, from=, to= or also=");
    *place->second = parsed<long>(item.substr(std::min(name.size() + 1, item.size()))).value_or(0);
    if (*place->second < 1) throw std::invalid_argument(item + ": expected a whole number >= 1");
    has_range = has_range || name == "from" || name == "to";
  }
  if (settings.every == 0 && !has_range)
    throw std::invalid_argument("expected every=, or from= and to=");
  if (settings.steps == 0) settings.steps = settings.every == 1 ? 1 : 2;
  if (settings.every > 0 && settings.steps > settings.every)
    throw std::invalid_argument("steps= is larger than every=");
  if (settings.to < settings.from) throw std::invalid_argument("to= is before from=");
  return settings;
}

bool CaptureSettings::takes(long step) const {
  if (step == also) return true;
  if (step < from || step > to) return false;
  // With every = n and steps = k: the steps n to n + k - 1, then 2 n to 2 n + k - 1, and so on.
  return every == 0 || (step >= every && step % every < steps);
}

void StepCapture::see(const StepRecord& record) {
  fastest_wall_ = std::max(fastest_wall_, std::abs(record.wall_v));
}

void StepCapture::observe(const TimeStepper& stepper, const MotionState& state,
                          const StepMemory& memory, const StepRecord& record) {
  see(record);
  if (!settings_.takes(state.step)) return;
  CapturedProblem captured;
  captured.problem = stepper.problem();
  captured.solution = stepper.impulses();
  stepper.warm_start(memory, captured.start);
  captured.h = h_;
  captured.g = g_;
  captured.step = static_cast<int>(state.step);
  captured.time = state.time;
  captured.phase = fastest_wall_ == 0.0 ? "none" : wall_state(record.wall_v, fastest_wall_);
  captured.wall_x = record.wall_x;
  captured.wall_v = record.wall_v;
  captured.load = record.load;
  for (const int c : stepper.assembler().detected()) {
    const ContactPoint& contact = memory.contacts[static_cast<size_t>(c)];
    captured.gap.push_back(contact.gap);
    captured.position.insert(captured.position.end(), contact.position.data(),
                             contact.position.data() + 3);
    captured.key.push_back(contact.feature);
    captured.id_a.push_back(contact.body_a);
    captured.id_b.push_back(contact.body_b);
    // Row by row in the world frame: the normal from a to b, then the two tangents.
    const Mat3 frame = contact_frame(contact.normal);
    for (int row = 0; row < 3; ++row)
      for (int axis = 0; axis < 3; ++axis) captured.frame.push_back(frame(row, axis));
  }
  create_folder(folder_);
  write_captured(folder_ / printed("step_%07ld.hdf5", state.step), captured);
}

}  // namespace ballast
