#include "platform/row_log.hpp"

#include <unistd.h>

#include <cerrno>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

constexpr std::uint64_t largest_row = std::uint64_t{1} << 32;  // numbers, as of 300 million bodies

/// The beginning of a file, before the SafeMark (row_log.hpp).
struct FixedHeader {
  char magic[8] = {'B', 'A', 'L', 'L', 'R', 'O', 'W', 'S'};
  std::uint32_t version = 1, byte_order = 0x01020304;
  std::uint64_t row_size = 0, owner = 0, text_length = 0;
};
static_assert(sizeof(FixedHeader) == 40);
constexpr size_t kind_bytes = 16;  // of the header, the same in all files

template <class Object>
std::string_view bytes_of(const Object& object) {
  return {reinterpret_cast<const char*>(&object), sizeof object};
}

std::string_view bytes_of(std::span<const double> row) {
  return {reinterpret_cast<const char*>(row.data()), row.size_bytes()};
}

/// The number of safe rows, at its fixed place after the header's fixed part. Only this mark is
/// written again.
struct SafeMark {
  std::uint64_t rows, checksum;
  explicit SafeMark(std::uint64_t count = 0) : rows(count), checksum(fnv1a(bytes_of(rows))) {}
};

std::uint64_t header_checksum(const FixedHeader& fixed, std::string_view text) {
  return fnv1a(text, fnv1a(bytes_of(fixed)));
}

/// Includes the row's number, so that rows that changed places are found as well.
std::uint64_t row_checksum(long number, std::span<const double> row) {
  return fnv1a(bytes_of(row), fnv1a(bytes_of(static_cast<std::uint64_t>(number))));
}

size_t row_bytes(size_t row_size) { return row_size * sizeof(double) + sizeof(std::uint64_t); }

OpenedFile open_file(const std::filesystem::path& path, const char* mode, const char* action) {
  errno = 0;
  OpenedFile file(std::fopen(path.c_str(), mode), std::fclose);
  if (!file) throw_file_error(path, action);
  return file;
}

}  // namespace

RowReader::RowReader(const std::filesystem::path& file)
    : path_(file), file_(open_file(file, "rb", "open")) {
  const auto refuse = [&](const std::string& why) { throw Error(path_.string() + ": " + why); };
  FixedHeader fixed;
  read(&fixed, sizeof fixed);
  if (!bytes_of(fixed).starts_with(bytes_of(FixedHeader()).substr(0, kind_bytes)))
    refuse("is not a log of a run of this program");
  // The mark has a checksum of its own: it is written again and again while the header stays.
  SafeMark safe;
  read(&safe, sizeof safe);
  if (safe.checksum != SafeMark(safe.rows).checksum)
    refuse("is damaged: the checksum of its count of rows is wrong");
  const std::uintmax_t bytes = std::filesystem::file_size(path_);
  if (fixed.text_length > bytes) refuse("is truncated in its header");
  // A row has at least one number, and its size in bytes does not overflow.
  if (fixed.row_size == 0 || fixed.row_size > largest_row)
    refuse("is damaged: a row of " + std::to_string(fixed.row_size) + " numbers");
  header_ = {std::string(fixed.text_length, ' '), fixed.owner, fixed.row_size};
  read(header_.text.data(), header_.text.size());
  std::uint64_t checksum;
  read(&checksum, sizeof checksum);
  if (checksum != header_checksum(fixed, header_.text))
    refuse("is damaged: the checksum of its header is wrong");
  header_bytes_ = sizeof fixed + sizeof safe + header_.text.size() + sizeof checksum;
  // The length of the file says how many whole rows there may be; their checksums decide later.
  row_count_ = static_cast<long>((bytes - header_bytes_) / row_bytes(header_.row_size));
  safe_count_ = static_cast<long>(safe.rows);
  if (safe_count_ < 0 || row_count_ < safe_count_)
    refuse("is truncated: " + std::to_string(row_count_) + " rows of " +
           std::to_string(safe_count_) + " are there");
  // Memory is allocated only for a row that the file is long enough for.
  if (row_count_ > 0) values_.resize(header_.row_size);
}

void RowReader::read(void* data, size_t bytes) {
  errno = 0;
  if (std::fread(data, 1, bytes, file_.get()) == bytes) return;
  if (std::ferror(file_.get())) throw_file_error(path_, "read");
  throw Error(path_.string() + ": is truncated" + (header_bytes_ == 0 ? " in its header" : ""));
}

std::span<const double> RowReader::next() {
  if (row_ == row_count_) return {};
  std::uint64_t checksum;
  read(values_.data(), values_.size() * sizeof(double));
  read(&checksum, sizeof checksum);
  // A damaged row that was never made safe is taken as the end of the log.
  if (checksum != row_checksum(row_, values_)) {
    if (row_ < safe_count_)
      throw Error(path_.string() + ": is damaged: the checksum of row " + std::to_string(row_) +
                  " is wrong");
    row_count_ = row_;
    return {};
  }
  ++row_;
  return values_;
}

RowWriter::RowWriter(const std::filesystem::path& file, const RowLogHeader& header)
    : path_(file), file_(open_file(file, "wb", "write")), row_size_(header.row_size) {
  const FixedHeader fixed{
      .row_size = header.row_size, .owner = header.owner, .text_length = header.text.size()};
  const std::uint64_t checksum = header_checksum(fixed, header.text);
  const SafeMark safe;
  for (const std::string_view part :
       {bytes_of(fixed), bytes_of(safe), std::string_view(header.text), bytes_of(checksum)})
    write(part);
  flush();
  sync_folder(path_.parent_path());
}

RowWriter::RowWriter(const std::filesystem::path& file, const RowReader& reader, long kept)
    : path_(file),
      file_(open_file(file, "r+b", "write")),
      row_size_(reader.header().row_size),
      row_count_(kept) {
  mark_safe(kept);  // before the cut, so that no more rows are marked safe than there are
  const long end = static_cast<long>(reader.header_bytes() + kept * row_bytes(row_size_));
  errno = 0;
  if (ftruncate(fileno(file_.get()), end) != 0) throw_file_error(path_, "cut back");
  if (std::fseek(file_.get(), end, SEEK_SET) != 0) throw_file_error(path_, "write");
}

void RowWriter::append(std::span<const double> row) {
  if (row.size() != row_size_)
    throw Error(path_.string() + ": a row of " + std::to_string(row.size()) +
                " numbers instead of " + std::to_string(row_size_));
  const std::uint64_t checksum = row_checksum(row_count_, row);
  write(bytes_of(row));
  write(bytes_of(checksum));
  ++row_count_;
}

void RowWriter::flush() {
  // The rows are made safe first, then the mark that says so.
  sync_to_disk(file_.get(), path_);
  mark_safe(row_count_);
}

void RowWriter::mark_safe(long rows) {
  const SafeMark safe(static_cast<std::uint64_t>(rows));
  errno = 0;
  if (pwrite(fileno(file_.get()), &safe, sizeof safe, sizeof(FixedHeader)) != sizeof safe)
    throw_file_error(path_, "write");
  sync_to_disk(file_.get(), path_);
}

void RowWriter::write(std::string_view bytes) {
  errno = 0;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    throw_file_error(path_, "write");
}

}  // namespace ballast
