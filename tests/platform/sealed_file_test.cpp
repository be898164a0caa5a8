#include "platform/sealed_file.hpp"

#include "platform/atomic_file.hpp"
#include "platform/content_key.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Matchers::Contains;

namespace {

constexpr SealedKind kind{"MAGICMAG", "thing", 3, 2};

std::string refusal(const std::filesystem::path& file, std::string_view bytes) {
  write_whole_file(file, bytes);
  try {
    read_sealed_file(file, kind);
  } catch (const Error& error) {
    const std::string message = error.what();
    CHECK(message.starts_with(file.string() + ": "));
    return message;
  }
  FAIL("no Error was thrown");
  return {};
}

}  // namespace

TEST_CASE("a sealed file's bytes are those of its description") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  write_sealed_file(file, kind, "body");
  std::string expected("MAGICMAG\x03\0\0\0\x04\x03\x02\x01\x04\0\0\0\0\0\0\0body", 28);
  std::uint64_t sum = fnv1a(expected);
  for (int k = 0; k < 8; ++k, sum >>= 8) expected += static_cast<char>(sum & 0xff);
  CHECK(read_whole_file(file) == expected);
  CHECK(read_sealed_file(file, kind).bytes == "body");
  CHECK(read_sealed_file(file, kind).format == 3);
}

TEST_CASE("formats from the oldest to the newest are read, others refused") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  for (const std::uint32_t format : {1u, 2u, 3u, 4u}) {
    write_sealed_file(file, {kind.magic, kind.name, format}, "body");
    if (format == 2 || format == 3)
      CHECK(read_sealed_file(file, kind).format == format);
    else
      CHECK_THAT(
          refusal(file, read_whole_file(file)),
          Contains("thing has format " + std::to_string(format) + ", this program reads format 3"));
  }
}

TEST_CASE("a sealed file that is cut, longer or changed in one bit is refused") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "file";
  write_sealed_file(file, kind, "some body");
  const std::string whole = read_whole_file(file);
  for (size_t length = 0; length < whole.size(); ++length)
    CHECK_THAT(refusal(file, std::string_view(whole).substr(0, length)),
               Contains(length == 0 ? "thing is empty" : "thing is truncated"));
  CHECK_THAT(refusal(file, whole + "x"), Contains("bytes follow its end"));
  for (size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string bytes = whole;
    bytes[bit / 8] ^= static_cast<char>(1 << bit % 8);
    refusal(file, bytes);
  }
  CHECK_THAT(refusal(file, "a text"), Contains("is not a thing"));
}
