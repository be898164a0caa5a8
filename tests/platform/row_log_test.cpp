#include "platform/row_log.hpp"

#include <cmath>

#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/complaint.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

const RowLogHeader header{"a,b,c", 0x1234567890abcdefull, 3};
constexpr size_t row_bytes = 3 * 8 + 8;

std::vector<double> row_of(long k) {
  const double x = static_cast<double>(k);
  return {x, -0.5 * x, std::nan("")};
}

/// Writes `safe` rows and flushes them, then `more` rows that reach the disk without a flush.
void write_rows(const fs::path& file, long safe, long more) {
  RowWriter writer(file, header);
  for (long k = 0; k < safe; ++k) writer.append(row_of(k));
  writer.flush();
  for (long k = safe; k < safe + more; ++k) writer.append(row_of(k));
}

long count_rows(RowReader& reader) {
  long count = 0;
  for (auto row = reader.next(); !row.empty(); row = reader.next(), ++count) {
    const std::vector<double> expected = row_of(count);
    REQUIRE(row.size() == 3);
    CHECK(row[0] == expected[0]);
    CHECK(row[1] == expected[1]);
    CHECK(std::isnan(row[2]));
  }
  return count;
}

/// The number of rows in the file, or the error's message after the file's name.
std::string read_all(const fs::path& file) {
  long rows = 0;
  const std::string said = complaint_about(file, [&] {
    RowReader reader(file);
    rows = count_rows(reader);
  });
  return said.empty() ? std::to_string(rows) : said;
}

void flip(const fs::path& file, size_t byte) {
  std::string bytes = read_whole_file(file);
  bytes.at(byte) = static_cast<char>(bytes.at(byte) ^ 0x10);
  write_whole_file(file, bytes);
}

}  // namespace

TEST_CASE("rows come back with their header") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "log";
  write_rows(file, 50, 7);
  RowReader reader(file);
  CHECK(reader.header().text == header.text);
  CHECK(reader.header().owner == header.owner);
  CHECK(reader.header().row_size == 3);
  CHECK(reader.safe_count() == 50);
  CHECK(reader.row_count() == 57);
  CHECK(fs::file_size(file) == reader.header_bytes() + 57 * row_bytes);
  CHECK(count_rows(reader) == 57);
  CHECK(reader.next().empty());
}

TEST_CASE("a log goes on after the rows that are kept") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "log";
  for (const long kept : {0L, 20L, 57L}) {
    write_rows(file, 50, 7);
    {
      RowReader reader(file);
      for (long k = 0; k < kept; ++k) reader.next();
      RowWriter writer(file, reader, kept);
      CHECK(writer.row_count() == kept);
      for (long k = kept; k < 60; ++k) writer.append(row_of(k));
      writer.flush();
    }
    CHECK(RowReader(file).safe_count() == 60);
    CHECK(read_all(file) == "60");
  }
}

TEST_CASE("the unsafe end may be cut off or damaged anywhere, a safe row may not") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "log";
  write_rows(file, 5, 3);
  const size_t begin = RowReader(file).header_bytes(), end = fs::file_size(file);
  for (size_t length = begin; length < end; ++length) {
    write_rows(file, 5, 3);
    fs::resize_file(file, length);
    const size_t whole = (length - begin) / row_bytes;
    CAPTURE(length);
    if (whole >= 5)
      CHECK(read_all(file) == std::to_string(whole));
    else
      CHECK(read_all(file) == "is truncated: " + std::to_string(whole) + " rows of 5 are there");
  }
  for (size_t byte = begin; byte < end; byte += 5) {
    write_rows(file, 5, 3);
    flip(file, byte);
    const size_t row = (byte - begin) / row_bytes;
    CAPTURE(byte);
    if (row >= 5)
      CHECK(read_all(file) == std::to_string(row));
    else
      CHECK(read_all(file) ==
            "is damaged: the checksum of row " + std::to_string(row) + " is wrong");
  }
}

TEST_CASE("no byte of the header can change unnoticed") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "log";
  write_rows(file, 2, 0);
  const size_t begin = RowReader(file).header_bytes();
  for (size_t byte = 0; byte < begin; ++byte) {
    write_rows(file, 2, 0);
    flip(file, byte);
    CAPTURE(byte);
    CHECK_THROWS_AS(RowReader(file), Error);
    write_rows(file, 2, 0);
    fs::resize_file(file, byte);
    CHECK_THROWS_AS(RowReader(file), Error);
  }
  write_whole_file(file, std::string(100, 'x'));
  CHECK(read_all(file) == "is not a log of a run of this program");
  CHECK(read_all(folder.path() / "absent") == "cannot open: No such file or directory");
}

TEST_CASE("rows that changed places are damaged") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "log";
  write_rows(file, 3, 0);
  const size_t begin = RowReader(file).header_bytes();
  std::string bytes = read_whole_file(file);
  const std::string first = bytes.substr(begin, row_bytes);
  bytes.replace(begin, row_bytes, bytes, begin + row_bytes, row_bytes);
  bytes.replace(begin + row_bytes, row_bytes, first);
  write_whole_file(file, bytes);
  CHECK(read_all(file) == "is damaged: the checksum of row 0 is wrong");
}

TEST_CASE("a row of another size is refused") {
  const TemporaryFolder folder;
  RowWriter writer(folder.path() / "log", header);
  CHECK_THROWS_WITH(writer.append(std::vector<double>(2)),
                    Catch::Contains("log: a row of 2 numbers instead of 3"));
}

TEST_CASE("a size of rows that no file can hold is refused, not asked of memory or divided by") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "log";
  // 2^61 - 1: the bytes of a row with its checksum would be 2^64, which overflows to zero.
  for (const size_t size : {size_t{0}, (size_t{1} << 61) - 1, size_t{1} << 40}) {
    RowWriter(file, {"", 0, size});
    CHECK(read_all(file) == "is damaged: a row of " + std::to_string(size) + " numbers");
  }
  // 32 GB a row, and no row there yet: a log that has just begun.
  RowWriter(file, {"", 0, size_t{1} << 32});
  CHECK(RowReader(file).next().empty());
}
