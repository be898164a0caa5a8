#include "experiments/record/checkpoint.hpp"

#include "platform/pack.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

Checkpoint sample_checkpoint(int contacts) {
  Random random(3);
  Checkpoint checkpoint;
  checkpoint.key = "0123456789abcdef";
  checkpoint.phase = "drive";
  checkpoint.state = sample_state(sample_system(), 77);
  for (int c = 0; c < contacts; ++c) {
    checkpoint.memory.contacts.push_back({c, c + 1, random.next(), random_direction(random),
                                          random_direction(random), random.uniform(-1e-4, 1e-4)});
    checkpoint.memory.impulses.push_back(random_direction(random));
  }
  return checkpoint;
}

/// Writes the file by the description of its bytes, with these numbers at its end.
void write_bytes(const fs::path& file, const Checkpoint& checkpoint,
                 const std::vector<double>& numbers) {
  Packer packer;
  const auto vector = [&](const Vec3& value) { packer.fixed(value); };
  packer.text(checkpoint.key);
  packer.text(checkpoint.phase);
  packer.number(checkpoint.state.time);
  packer.number(std::int64_t{checkpoint.state.step});
  packer.list(checkpoint.state.pose, [&](const Pose& pose) {
    vector(pose.position);
    packer.number(pose.rotation.w());
    vector(pose.rotation.vec());
  });
  packer.list(checkpoint.state.velocity, vector);
  packer.list(checkpoint.state.spin, vector);
  packer.list(checkpoint.memory.contacts, [&](const ContactPoint& contact) {
    packer.number(std::int32_t{contact.body_a});
    packer.number(std::int32_t{contact.body_b});
    packer.number(std::uint64_t{contact.feature});
    vector(contact.normal);
    vector(contact.position);
    packer.number(contact.gap);
  });
  packer.list(checkpoint.memory.impulses, vector);
  packer.list(numbers);
  write_sealed_file(file, {"BALLCKPT", "checkpoint", 1}, packer.bytes());
}

}  // namespace

TEST_CASE("a checkpoint comes back to the last bit, and its bytes are these") {
  // The format is fixed, so that stored packings stay useful.
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  Checkpoint drive = sample_checkpoint(4), packing = sample_checkpoint(40);
  packing.phase = "packing";
  packing.deposit = {0.25, -0.0, 1e-310, std::numeric_limits<double>::infinity()};
  for (const Checkpoint& checkpoint : {drive, packing, Checkpoint{}}) {
    write_checkpoint(file, checkpoint);  // replaces the previous file
    CHECK(same_bits(read_checkpoint(file), checkpoint));
    CHECK_FALSE(fs::exists(file.string() + ".tmp"));
    const std::string bytes = file_bytes(file);
    const DepositState& d = checkpoint.deposit;
    write_bytes(file, checkpoint, {d.top, d.lid, d.rain_time, d.rest_velocity});
    CHECK(file_bytes(file) == bytes);
  }
}

TEST_CASE("a checkpoint that does not fit together is refused with its name") {
  // tests/platform/pack_test.cpp tests the other faults of a sealed file.
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  const auto refusal = [&] {
    const std::string message = run_error([&] { read_checkpoint(file); });
    CHECK(message.starts_with(file.string()));
    return message;
  };
  CHECK_THAT(refusal(), Contains("cannot open: No such file"));
  put_bytes(file, "solid ballast\nfacet normal 0 0 1\n");
  CHECK_THAT(refusal(), Contains("is not a checkpoint"));
  void (*const changes[])(Checkpoint&) = {[](Checkpoint& c) { c.state.velocity.pop_back(); },
                                          [](Checkpoint& c) { c.state.spin.pop_back(); },
                                          [](Checkpoint& c) { c.memory.impulses.pop_back(); }};
  for (const auto& change : changes) {
    Checkpoint checkpoint = sample_checkpoint(4);
    change(checkpoint);
    write_checkpoint(file, checkpoint);
    CHECK_THAT(refusal(), Contains("a list has a wrong length"));
  }
  write_bytes(file, sample_checkpoint(4), {2.0, 1.0, 3.0});
  CHECK_THAT(refusal(), Contains("a list has a wrong length"));
}
