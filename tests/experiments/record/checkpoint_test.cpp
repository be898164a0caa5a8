#include "experiments/record/checkpoint.hpp"

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
    checkpoint.contacts.push_back({c, c + 1, random.next(), random_direction(random),
                                   random_direction(random), random.uniform(-1e-4, 1e-4)});
    checkpoint.impulses.push_back(random_direction(random));
  }
  checkpoint.numbers = {1.5, -0.0, std::numeric_limits<double>::infinity()};
  return checkpoint;
}

void check_equal(const Checkpoint& a, const Checkpoint& b) {
  CHECK(a.key == b.key);
  CHECK(a.phase == b.phase);
  CHECK(same_bits(a.state.time, b.state.time));
  CHECK(a.state.step == b.state.step);
  CHECK(same_bits(a.state.pose, b.state.pose));
  CHECK(same_bits(a.state.velocity, b.state.velocity));
  CHECK(same_bits(a.state.spin, b.state.spin));
  REQUIRE(a.contacts.size() == b.contacts.size());
  for (size_t c = 0; c < a.contacts.size(); ++c) {
    const ContactPoint &p = a.contacts[c], &q = b.contacts[c];
    CHECK((p.body_a == q.body_a && p.body_b == q.body_b && p.feature == q.feature));
    CHECK((same_bits(p.normal, q.normal) && same_bits(p.position, q.position) &&
           same_bits(p.gap, q.gap)));
  }
  CHECK(same_bits(a.impulses, b.impulses));
  CHECK(same_bits(a.numbers, b.numbers));
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
  CHECK_THAT(run_error([&] { write_checkpoint(folder.path(), {}); }),
             Contains("not a regular file"));
}
