// The append-only logs of a run. The checksums of every second input are corrected, so that the
// fuzzer passes their check; the others stay as they are.

#include <cstring>

#include "platform/row_log.hpp"
#include "platform/text.hpp"
#include "tests/fuzz/fuzz_file.hpp"

using namespace ballast;

namespace {

/// The positions of a log's fields (platform/row_log.hpp), in bytes.
constexpr std::size_t fixed_bytes = 40, row_size_at = 16, text_length_at = 32, safe_at = 40,
                      text_at = 56;

std::uint64_t word(const std::string& bytes, std::size_t at) {
  std::uint64_t value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

void put(std::string& bytes, std::size_t at, std::uint64_t value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void mend_checksums(std::string& log) {
  if (log.size() < text_at + 8) return;
  const std::string_view all(log);
  put(log, safe_at + 8, fnv1a(all.substr(safe_at, 8)));
  const std::uint64_t length = word(log, text_length_at);
  if (length > log.size() - text_at - 8) return;
  put(log, text_at + length, fnv1a(all.substr(text_at, length), fnv1a(all.substr(0, fixed_bytes))));
  const std::uint64_t row = 8 * word(log, row_size_at);
  if (row == 0 || row > log.size()) return;
  std::uint64_t number = 0;
  for (std::size_t at = text_at + length + 8; at + row + 8 <= log.size(); at += row + 8) {
    const std::string_view counted(reinterpret_cast<const char*>(&number), 8);
    put(log, at + row, fnv1a(all.substr(at, row), fnv1a(counted)));
    ++number;
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string log(fuzz::text_of(data, size));
  if (size % 2 == 0) mend_checksums(log);
  const auto file = fuzz::input_folder().write("steps.bin", log);
  fuzz::refused_or(file, [&] {
    RowReader reader(file);
    long rows = 0;
    while (!reader.next().empty()) ++rows;
    if (rows < reader.safe_count()) fuzz::finding("fewer rows than are safe");
    const RowWriter writer(file, reader, std::min(rows, 1L));
  });
  return 0;
}
