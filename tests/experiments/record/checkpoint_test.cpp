#include "experiments/record/checkpoint.hpp"

#include "platform/pack.hpp"
#include "tests/support/file_size_limit.hpp"
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

std::vector<double> numbers_of(const DepositState& deposit) {
  return {deposit.lid, deposit.top, deposit.rain_time, deposit.rest_velocity};
}

void check_equal(const Checkpoint& a, const Checkpoint& b) {
  CHECK(a.key == b.key);
  CHECK(a.phase == b.phase);
  CHECK(same_bits(a.state.time, b.state.time));
  CHECK(a.state.step == b.state.step);
  CHECK(same_bits(a.state.pose, b.state.pose));
  CHECK(same_bits(a.state.velocity, b.state.velocity));
  CHECK(same_bits(a.state.spin, b.state.spin));
  REQUIRE(a.memory.contacts.size() == b.memory.contacts.size());
  for (size_t c = 0; c < a.memory.contacts.size(); ++c) {
    const ContactPoint &p = a.memory.contacts[c], &q = b.memory.contacts[c];
    CHECK((p.body_a == q.body_a && p.body_b == q.body_b && p.feature == q.feature));
    CHECK((same_bits(p.normal, q.normal) && same_bits(p.position, q.position) &&
           same_bits(p.gap, q.gap)));
  }
  CHECK(same_bits(a.memory.impulses, b.memory.impulses));
  REQUIRE(a.deposit.has_value() == b.deposit.has_value());
  if (a.deposit) CHECK(same_bits(numbers_of(*a.deposit), numbers_of(*b.deposit)));
}

/// The file as its bytes are described, with any numbers at its end.
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

std::string refusal(const fs::path& file) {
  const std::string message = run_error([&] { read_checkpoint(file); });
  CHECK(message.rfind(file.string(), 0) == 0);
  CHECK(message.find('\n') == std::string::npos);
  return message;
}

}  // namespace

TEST_CASE("a checkpoint comes back to the last bit") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  for (int contacts : {0, 40}) {
    write_checkpoint(file, sample_checkpoint(contacts));  // the second time over the first
    check_equal(read_checkpoint(file), sample_checkpoint(contacts));
    CHECK_FALSE(fs::exists(file.string() + ".tmp"));
  }
  write_checkpoint(file, {});
  check_equal(read_checkpoint(file), {});
  Checkpoint packing = sample_checkpoint(3);
  packing.phase = "packing";
  packing.deposit = DepositState{0.25, -0.0, 1e-310, std::numeric_limits<double>::infinity()};
  write_checkpoint(file, packing);
  check_equal(read_checkpoint(file), packing);
}

TEST_CASE("the bytes of a checkpoint are these: packings that were kept stay useful") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  const auto check_bytes = [&](const Checkpoint& checkpoint, const std::vector<double>& numbers) {
    write_bytes(file, checkpoint, numbers);
    check_equal(read_checkpoint(file), checkpoint);
    const std::string bytes = file_bytes(file);
    write_checkpoint(file, checkpoint);
    CHECK(file_bytes(file) == bytes);
  };
  Checkpoint checkpoint = sample_checkpoint(4);
  check_bytes(checkpoint, {});
  checkpoint.phase = "packing";
  checkpoint.deposit = DepositState{1.0, 2.0, 3.0, 4.0};
  check_bytes(checkpoint, {2.0, 1.0, 3.0, 4.0});
  write_bytes(file, checkpoint, {2.0, 1.0, 3.0});
  CHECK_THAT(refusal(file), Contains("a list has a wrong length"));
}

TEST_CASE("lists of a checkpoint that do not fit each other are refused") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  const auto refused = [&](auto&& change, const std::string& why) {
    Checkpoint checkpoint = sample_checkpoint(4);
    change(checkpoint);
    write_checkpoint(file, checkpoint);
    CHECK_THAT(refusal(file), Contains(why));
  };
  refused([](Checkpoint& c) { c.state.velocity.pop_back(); }, "a list has a wrong length");
  refused([](Checkpoint& c) { c.state.spin.pop_back(); }, "a list has a wrong length");
  refused([](Checkpoint& c) { c.memory.impulses.pop_back(); }, "a list has a wrong length");
}

TEST_CASE("equal checkpoints are equal bytes") {
  const TemporaryFolder folder;
  write_checkpoint(folder.path() / "a", sample_checkpoint(5));
  write_checkpoint(folder.path() / "b", sample_checkpoint(5));
  CHECK(file_bytes(folder.path() / "a") == file_bytes(folder.path() / "b"));
}

TEST_CASE("a checkpoint cut at any byte is refused") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  write_checkpoint(file, sample_checkpoint(6));
  const std::string whole = file_bytes(file);
  for (size_t length = 0; length < whole.size(); ++length) {
    put_bytes(file, std::string_view(whole).substr(0, length));
    const std::string message = refusal(file);
    const bool says_so =
        message.find(length == 0 ? "is empty" : "is truncated") != std::string::npos;
    if (!says_so) FAIL_CHECK(length << " bytes: " << message);
  }
}

TEST_CASE("a checkpoint with any bit flipped, or with bytes behind its end, is refused") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  write_checkpoint(file, sample_checkpoint(6));
  std::string bytes = file_bytes(file);
  for (size_t at = 0; at < bytes.size(); ++at) {
    const char bit = static_cast<char>(1 << at % 8);
    bytes[at] ^= bit;
    put_bytes(file, bytes);
    refusal(file);
    bytes[at] ^= bit;
  }
  put_bytes(file, bytes + '\0');
  CHECK_THAT(refusal(file), Contains("bytes follow its end"));
  put_bytes(file, bytes);
  check_equal(read_checkpoint(file), sample_checkpoint(6));
}

TEST_CASE("every defect of a checkpoint has its own message") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  CHECK_THAT(refusal(file), Contains("cannot open: No such file"));
  CHECK_THAT(refusal(folder.path()), Contains("cannot"));
  put_bytes(file, "solid ballast\nfacet normal 0 0 1\n");
  CHECK_THAT(refusal(file), Contains("is not a checkpoint"));
  write_checkpoint(file, sample_checkpoint(6));
  const std::string whole = file_bytes(file);
  const auto changed = [&](size_t at, char value) {
    std::string bytes = whole;
    bytes[at] = value;
    put_bytes(file, bytes);
    return refusal(file);
  };
  CHECK_THAT(changed(8, 9), Contains("has format 9, this program reads format 1"));
  CHECK_THAT(changed(12, 1), Contains("another byte order"));
  CHECK_THAT(changed(100, whole[100] ^ 1), Contains("its checksum is wrong"));
}

TEST_CASE("a checkpoint that cannot be written leaves the old one") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "checkpoint.bin";
  write_checkpoint(file, sample_checkpoint(1));
  SECTION("a full disk") {
    fs::create_symlink("/dev/full", file.string() + ".tmp");
    CHECK_THAT(run_error([&] { write_checkpoint(file, sample_checkpoint(9)); }),
               Contains(file.string()) && Contains("No space left"));
  }
  SECTION("a file that cannot grow") {
    const FileSizeLimit limit(512);
    CHECK_THAT(run_error([&] { write_checkpoint(file, sample_checkpoint(9)); }),
               Contains(file.string()) && Contains("File too large"));
  }
  check_equal(read_checkpoint(file), sample_checkpoint(1));
  CHECK_FALSE(fs::exists(file.string() + ".tmp"));
  const fs::path nowhere = folder.path() / "no" / "checkpoint.bin";
  CHECK_THAT(run_error([&] { write_checkpoint(nowhere, {}); }),
             Contains(nowhere.string()) && Contains("No such file"));
  CHECK_THAT(run_error([&] { write_checkpoint(folder.path(), {}); }), Contains("Is a directory"));
}
