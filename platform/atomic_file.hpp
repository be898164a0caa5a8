#pragma once
// Files and folders: atomic writing, queries of a path, and a lock for one worker at a time.

#include <cstdio>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <string>
#include <string_view>

namespace ballast {

/// A file written as `<target>.tmp` beside its target; commit() makes it safe on disk and renames
/// it over the target. Without commit() the target stays as it was and the neighbour is removed. A
/// symbolic link stays: the file that it points to is the target. Devices, pipes and the file
/// behind /dev/stdout are written directly, never replaced. Every failure is an Error that names
/// the file as it was given and the reason.
class AtomicFile {
 public:
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);

  /// The neighbour's descriptor, for a file that is not written from beginning to end by write().
  /// Throws Error where the target itself is written, as a pipe is: it cannot be positioned.
  int descriptor() const;

  void commit();

 private:
  std::filesystem::path name_;       // as it was given
  std::filesystem::path target_;     // the file that it leads to; empty: written directly
  std::filesystem::path neighbour_;  // the temporary file until it is renamed
  std::FILE* file_ = nullptr;
};

/// Writes all of `text` through an AtomicFile.
void write_whole_file(const std::filesystem::path& target, std::string_view text);

/// Returns the whole file. Throws Error where it is missing, unreadable or no regular file. A pipe
/// or a device is never waited for: it could be endless.
std::string read_whole_file(const std::filesystem::path& file);

/// Makes a folder and its parents. Throws Error.
void create_folder(const std::filesystem::path& folder);

/// Identifies a folder of results by a subfolder, or by a file that contains these words.
struct OwnMark {
  OwnMark(const char* name_, const char* words_ = nullptr) : name(name_), words(words_) {}
  const char *name, *words;
};

/// Checks a folder before results are written into it. Throws Error unless it is missing, holds no
/// complete file, or has one of these marks of a folder of the same kind of results. Any other
/// content is somebody else's and must not be mixed with results.
void require_own_folder(const std::filesystem::path& folder, std::initializer_list<OwnMark> known);

/// Throws Error "<file>: cannot <action>: <errno's text>".
[[noreturn]] void throw_file_error(const std::filesystem::path& file, std::string_view action);

/// Flushes to the disk, not only to the kernel. Throws Error naming `file`.
void sync_to_disk(std::FILE* stream, const std::filesystem::path& file);
/// Flushes the entries of a folder to the disk, after a file was created or renamed in it.
void sync_folder(const std::filesystem::path& folder);

// Queries of a path; links are followed. std::filesystem's own queries throw for a name that the
// system refuses (longer than a file's name may be, a folder that may not be entered). Words of a
// command line and of a scene can be such names: for them these queries return false.

inline bool path_exists(const std::filesystem::path& path) noexcept {
  std::error_code refused;
  return std::filesystem::exists(path, refused);
}

/// A regular file: not a folder, a pipe or a device.
inline bool is_file(const std::filesystem::path& path) noexcept {
  std::error_code refused;
  return std::filesystem::is_regular_file(path, refused);
}

inline bool is_folder(const std::filesystem::path& path) noexcept {
  std::error_code refused;
  return std::filesystem::is_directory(path, refused);
}

/// A lock for one worker at a time, released when its process ends in any way. It uses flock on a
/// file that is created for it and removed with it. The kernel releases it when the process dies,
/// kill -9 included, and child processes that execute another program do not inherit it. Over NFS
/// it is a lock among all machines that mount the folder.
class FileLock {
 public:
  /// Asks whether to go on waiting; called some twenty times a second.
  using Patience = std::function<bool(double seconds_waited)>;

  /// Waits until the lock is free. When `patience` returns false it gives up, and is_held() is
  /// false. The folder must exist. Throws Error when the file cannot be created or locked, or is a
  /// link or somebody else's file.
  FileLock(std::filesystem::path file, const Patience& patience);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool is_held() const { return descriptor_ >= 0; }
  /// Throws Error "<folder>: <holder> is working there" unless it is held.
  void require_held() const;
  /// The holder of a lock that was not free: "process 123 on host", as far as the file says.
  const std::string& holder() const { return holder_; }

 private:
  bool try_once();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string holder_ = "another process";
};

/// A patience of 3 s, for locks that are free unless somebody works: a holder may be just dying.
bool briefly(double seconds_waited);

}  // namespace ballast
