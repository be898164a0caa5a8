#pragma once
// Files that are there whole or not at all.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace ballast {

/// A file written as `<target>.tmp` beside its target; commit() makes it safe on disk and renames
/// it over the target. Without commit() the target stays as it was and the neighbour is removed.
/// A symbolic link stays: what it points to is the target. Devices, pipes and what /dev/stdout
/// leads to are written as they are, never replaced. Every failure is an Error that names the file
/// as it was given and the reason.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void print(const char* format, ...) __attribute__((format(printf, 2, 3)));

  /// For what is not written from its beginning to its end, instead of write(). Where there is no
  /// going back, as in a pipe, the bytes are gathered in memory until commit().
  void write_at(std::uint64_t offset, std::string_view bytes);
  /// What stands there; zeros behind the end.
  void read_at(std::uint64_t offset, std::span<char> bytes) const;
  /// Cuts the end off, or appends zeros.
  void set_length(std::uint64_t bytes);

  void commit();

 private:
  void close();
  std::filesystem::path name_;       // as it was given
  std::filesystem::path target_;     // what it leads to
  std::filesystem::path neighbour_;  // empty: the target itself is written
  std::FILE* file_ = nullptr;
  std::string gathered_;  // where there is no going back
};

/// Writes all of `text` through an AtomicFile.
void write_whole_file(const std::filesystem::path& target, std::string_view text);

/// The whole file. Throws Error: missing, unreadable, or no regular file. A pipe or a device is
/// never waited for: it could be without end.
std::string read_whole_file(const std::filesystem::path& file);

/// Makes a folder and its parents. Throws Error.
void create_folder(const std::filesystem::path& folder);

/// Before results are written into a folder. Throws Error unless it is missing, empty, or has a
/// subfolder of one of these names, by which a folder of the same kind of results is known: what
/// else is there is somebody's, and is not to be mixed with results.
void require_own_folder(const std::filesystem::path& folder,
                        std::initializer_list<const char*> known);

/// Throws Error "<file>: cannot <action>: <errno's text>".
[[noreturn]] void throw_file_error(const std::filesystem::path& file, std::string_view action);

/// Flush to the disk, not only to the kernel. Throws Error naming `file`.
void sync_to_disk(std::FILE* stream, const std::filesystem::path& file);
/// The same for the entries of a folder: after a file was created or renamed in it.
void sync_folder(const std::filesystem::path& folder);

}  // namespace ballast
