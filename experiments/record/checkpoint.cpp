#include "experiments/record/checkpoint.hpp"

#include <array>

#include "platform/pack.hpp"

namespace ballast {
namespace {

constexpr SealedKind checkpoint_kind{"BALLCKPT", "checkpoint", 1};

/// Packs or unpacks everything except the deposit.
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

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint) {
  Packer packer;
  carry_motion(packer, checkpoint);
  const DepositState& d = checkpoint.deposit;
  packer.list(std::array{d.top, d.lid, d.rain_time, d.rest_velocity});
  write_sealed_file(file, checkpoint_kind, packer.bytes());
}

Checkpoint read_checkpoint(const std::filesystem::path& file) {
  const std::string body = read_sealed_file(file, checkpoint_kind);
  Unpacker unpacker(body, file.string() + ": checkpoint");
  Checkpoint checkpoint;
  std::vector<double> deposit;
  carry_motion(unpacker, checkpoint);
  unpacker.list(deposit);
  unpacker.finish();
  unpacker.require(deposit.size() == 4);
  checkpoint.deposit = {deposit[0], deposit[1], deposit[2], deposit[3]};
  // An intact file may still be inconsistent.
  const MotionState& state = checkpoint.state;
  unpacker.require(state.velocity.size() == state.pose.size());
  unpacker.require(state.spin.size() == state.pose.size());
  unpacker.require(checkpoint.memory.impulses.size() == checkpoint.memory.contacts.size());
  return checkpoint;
}

}  // namespace ballast
