#include "experiments/record/checkpoint.hpp"

#include <cmath>
#include <limits>

#include "platform/error.hpp"
#include "platform/pack.hpp"

namespace ballast {
namespace {

constexpr SealedKind checkpoint_kind{"BALLCKPT", "checkpoint", 1};
constexpr const char* packing_phase = "packing";

/// All but what belongs to the phase.
template <class Carrier, class Of>
void carry_motion(Carrier& carrier, Of& checkpoint) {
  const auto vector = [&](auto& value) { carrier.fixed(value); };
  carrier.text(checkpoint.key);
  carrier.text(checkpoint.phase);
  auto& state = checkpoint.state;
  carrier.numbers(state.time, state.step);
  carrier.list(state.pose, [&](auto& pose) {
    carrier.fixed(pose.position);
    auto& q = pose.rotation;
    carrier.numbers(q.w(), q.x(), q.y(), q.z());
  });
  carrier.list(state.velocity, vector);
  carrier.list(state.spin, vector);
  carrier.list(checkpoint.memory.contacts, [&](auto& contact) {
    carrier.numbers(contact.body_a, contact.body_b, contact.feature);
    carrier.fixed(contact.normal);
    carrier.fixed(contact.position);
    carrier.number(contact.gap);
  });
  carrier.list(checkpoint.memory.impulses, vector);
}

/// What belongs to the phase ends the file, as a list of doubles that means another thing in each.
/// This is the one place that knows which: {top, lid, rain time, rest velocity} of a packing, {lid,
/// top, rain time} of a deposit that goes on, steps at rest of each body in a drive.
std::vector<double> phase_numbers(const Checkpoint& checkpoint) {
  if (!checkpoint.deposit) return {checkpoint.memory.rest.begin(), checkpoint.memory.rest.end()};
  const DepositState& d = *checkpoint.deposit;
  if (checkpoint.phase == packing_phase) return {d.top, d.lid, d.rain_time, d.rest_velocity};
  return {d.lid, d.top, d.rain_time};
}

void take_phase_numbers(const std::vector<double>& numbers, const Unpacker& unpacker,
                        Checkpoint& checkpoint) {
  const std::string& phase = checkpoint.phase;
  if (phase == packing_phase) {
    unpacker.require(numbers.size() == 4);
    checkpoint.deposit = DepositState{numbers[1], numbers[0], numbers[2], numbers[3]};
  } else if (phase == "rain" || phase == "press" || phase == "settle") {
    unpacker.require(numbers.size() == 3);
    checkpoint.deposit = DepositState{numbers[0], numbers[1], numbers[2], 0.0};
  } else {
    for (const double number : numbers) {
      unpacker.require(std::abs(number) <= std::numeric_limits<int>::max() &&
                       number == std::floor(number));
      checkpoint.memory.rest.push_back(static_cast<int>(number));
    }
  }
}

/// A file may be whole and yet not fit together: every body has a pose, a velocity and a
/// spin, and every contact an impulse.
void check(const Checkpoint& checkpoint, const Unpacker& unpacker,
           const std::filesystem::path& file) {
  const size_t bodies = checkpoint.state.pose.size();
  unpacker.require(checkpoint.state.velocity.size() == bodies);
  unpacker.require(checkpoint.state.spin.size() == bodies);
  unpacker.require(checkpoint.memory.impulses.size() == checkpoint.memory.contacts.size());
  const std::vector<int>& rest = checkpoint.memory.rest;
  if (!rest.empty() && rest.size() != bodies)
    throw Error(file.string() + ": checkpoint is inconsistent: rest of " +
                std::to_string(rest.size()) + " bodies");
  for (const int steps : rest)
    if (steps < StepMemory::asleep)
      throw Error(file.string() + ": checkpoint is inconsistent: " + std::to_string(steps) +
                  " is no number of steps at rest");
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  Packer packer;
  carry_motion(packer, checkpoint);
  packer.list(phase_numbers(checkpoint));
  write_sealed_file(file, checkpoint_kind, packer.bytes());
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const std::string body = read_sealed_file(file, checkpoint_kind);
  Unpacker unpacker(body, file.string() + ": checkpoint");
  Checkpoint checkpoint;
  std::vector<double> numbers;
  carry_motion(unpacker, checkpoint);
  unpacker.list(numbers);
  unpacker.finish();
  take_phase_numbers(numbers, unpacker, checkpoint);
  check(checkpoint, unpacker, file);
  return checkpoint;
}

}  // namespace ballast
