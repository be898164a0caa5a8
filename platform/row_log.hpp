#pragma once
// Append-only file of fixed-size rows of doubles, for a run that may be killed at any moment.
//
//   magic "BALLROWS", u32 version, u32 byte order, u64 doubles per row, u64 owner, u64 length of
//   text, u64 safe, u64 checksum of safe, text, u64 checksum of all of this without safe, then
//   rows: doubles, u64 checksum of the row's number and its doubles.
//
// The first `safe` rows have been made safe on disk: it is an error when one of them is cut off or
// damaged. The rows after them are read up to the first that is not whole: the end of a log after a
// power cut may hold anything.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ballast {

struct RowLogHeader {
  std::string text;         ///< the kind of rows and the names of their columns
  std::uint64_t owner = 0;  ///< key of what the rows belong to
  size_t row_size = 0;      ///< doubles per row
};

using OpenedFile = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Reads rows from the first one on. Every defect is an Error that names the file.
class RowReader {
 public:
  explicit RowReader(const std::filesystem::path& file);

  const RowLogHeader& header() const { return header_; }
  /// The number of rows that must be there, and of rows that the file is long enough for.
  long safe_count() const { return safe_count_; }
  long row_count() const { return row_count_; }
  /// Bytes before the first row.
  size_t header_bytes() const { return header_bytes_; }

  /// The next row, valid until the next call; empty after the last. Throws Error when a safe row is
  /// damaged.
  std::span<const double> next();

 private:
  void read(void* data, size_t bytes);

  std::filesystem::path path_;
  OpenedFile file_;
  RowLogHeader header_;
  size_t header_bytes_ = 0;
  long row_count_ = 0, safe_count_ = 0, row_ = 0;
  std::vector<double> values_;
};

/// Appends rows. They are buffered, and safe on disk after flush().
class RowWriter {
 public:
  /// Creates the file, or replaces it.
  RowWriter(const std::filesystem::path& file, const RowLogHeader& header);
  /// Continues a file after its first `kept` rows and cuts off the rows after them. `reader` has
  /// read that file so far.
  RowWriter(const std::filesystem::path& file, const RowReader& reader, long kept);

  void append(std::span<const double> row);
  /// Makes all rows so far safe on disk.
  void flush();
  long row_count() const { return row_count_; }

 private:
  void write(std::string_view bytes);
  void mark_safe(long rows);

  std::filesystem::path path_;
  OpenedFile file_;
  size_t row_size_ = 0;
  long row_count_ = 0;
};

}  // namespace ballast
