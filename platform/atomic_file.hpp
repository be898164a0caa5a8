#pragma once
// Files and folders: whole or not at all, what a name leads to, one worker at a time.

#include <cstdio>
#include <filesystem>
#include <functional>
#include <initializer_list>
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

  void write(std::string_view text);

  /// For what is not written from its beginning to its end, instead of write(): of the neighbour.
  /// Throws Error where the target itself is written, as a pipe is: there is no going back in it.
  int descriptor() const;

  void commit();

 private:
  std::filesystem::path name_;       // as it was given
  std::filesystem::path target_;     // what it leads to; empty: it is written as it is
  std::filesystem::path neighbour_;  // until it is renamed
  std::FILE* file_ = nullptr;
};

/// Writes all of `text` through an AtomicFile.
void write_whole_file(const std::filesystem::path& target, std::string_view text);

/// The whole file. Throws Error: missing, unreadable, or no regular file. A pipe or a device is
/// never waited for: it could be without end.
std::string read_whole_file(const std::filesystem::path& file);

/// Makes a folder and its parents. Throws Error.
void create_folder(const std::filesystem::path& folder);

/// By what a folder of results is known: a subfolder, or a file that has these words in it.
struct OwnMark {
  OwnMark(const char* name_, const char* words_ = nullptr) : name(name_), words(words_) {}
  const char *name, *words;
};

/// Before results are written into a folder. Throws Error unless it is missing, has no whole file,
/// or one of these marks, by which a folder of the same kind of results is known: what else is
/// there is somebody's, and is not to be mixed with results.
void require_own_folder(const std::filesystem::path& folder, std::initializer_list<OwnMark> known);

/// Throws Error "<file>: cannot <action>: <errno's text>".
[[noreturn]] void throw_file_error(const std::filesystem::path& file, std::string_view action);

/// Flush to the disk, not only to the kernel. Throws Error naming `file`.
void sync_to_disk(std::FILE* stream, const std::filesystem::path& file);
/// The same for the entries of a folder: after a file was created or renamed in it.
void sync_folder(const std::filesystem::path& folder);

// What a name leads to, links followed. std::filesystem's own questions throw for a name that the
// system refuses (longer than a file's name may be, a folder that may not be entered). Words of a
// command line and of a scene are such names: nothing is there then.

inline bool is_there(const std::filesystem::path& path) noexcept {
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

/// One worker at a time: a lock that goes with its process, however that ends.
/// flock on a file that is made for it and removed with it. The kernel lets go when the process
/// dies, kill -9 included, and children that are another program don't inherit it. Over NFS it is a
/// lock among all machines that mount the folder.
class FileLock {
 public:
  /// Asks whether to go on waiting; called some twenty times a second.
  using Patience = std::function<bool(double seconds_waited)>;

  /// Waits until the lock is free; `patience` returning false gives up: is_held() is then false.
  /// The folder must be there. Throws Error when the file cannot be made or locked, or is a link or
  /// somebody's.
  FileLock(std::filesystem::path file, const Patience& patience);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool is_held() const { return descriptor_ >= 0; }
  /// Throws Error "<folder>: <holder> is working there" unless it is held.
  void require_held() const;
  /// Who holds the lock that could not be had: "process 123 on host", as far as the file says.
  const std::string& holder() const { return holder_; }

 private:
  bool try_once();

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::string holder_ = "another process";
};

/// For locks that are free unless somebody is at work: waits for one who is just dying.
bool briefly(double seconds_waited);

}  // namespace ballast
