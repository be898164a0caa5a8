#include "platform/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <memory>
#include <string>
#include <utility>

#include "platform/error.hpp"

namespace ballast {

namespace fs = std::filesystem;

void throw_file_error(const fs::path& file, std::string_view action) {
  const int error = errno;
  std::string message = file.string() + ": cannot " + std::string(action);
  if (error != 0) message += std::string(": ") + std::strerror(error);
  throw Error(message);
}

void sync_to_disk(std::FILE* stream, const fs::path& file) {
  errno = 0;
  // EINVAL, EROFS: pipes and special files, where there is nothing to sync
  if (std::fflush(stream) != 0 || (fsync(fileno(stream)) != 0 && errno != EINVAL && errno != EROFS))
    throw_file_error(file, "write");
}

void sync_folder(const fs::path& folder) {
  errno = 0;
  const int descriptor = open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
  if (descriptor < 0) throw_file_error(folder, "open");
  fsync(descriptor);  // where a file system refuses it, the rename is as safe as it gets
  ::close(descriptor);
}

namespace {

/// Where a file's name leads: whether it must be written in place, and to which regular file.
struct Destination {
  bool is_in_place = false;
  fs::path file;
};

/// Follows symbolic links one by one. One that passes through /proc, as /dev/stdout does, means an
/// open descriptor: a file that somebody has open must not be replaced under his hands.
Destination destination_of(const fs::path& name) {
  Destination end{false, name};
  std::error_code error;
  constexpr int most_links = 40;  // as many as the kernel follows
  for (int link = 0; link < most_links && fs::is_symlink(end.file, error); ++link) {
    const fs::path next = fs::read_symlink(end.file, error);
    if (error) break;
    const fs::path followed = end.file.parent_path() / next;  // `next` alone where it is absolute
    if (followed.lexically_normal().string().starts_with("/proc/")) return {true, name};
    end.file = followed;
  }
  if (fs::is_symlink(end.file, error)) return {true, name};  // a ring: opening it says so
  const fs::file_status status = fs::status(end.file, error);
  end.is_in_place = fs::exists(status) && !fs::is_regular_file(status);
  return end;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : name_(std::move(target)) {
  const Destination destination = destination_of(name_);
  target_ = destination.file;
  errno = 0;
  if (destination.is_in_place) {
    file_ = std::fopen(target_.c_str(), "wb");  // a folder: "Is a directory"
  } else {
    // Written beside the target and renamed over it: readers see the
    // old file or the new one, whole.
    neighbour_ = target_.string() + ".tmp";
    file_ = std::fopen(neighbour_.c_str(), "w+b");
    struct stat old, mine;
    // Who may read and write it stays as it was.
    if (file_ && stat(target_.c_str(), &old) == 0 && fstat(fileno(file_), &mine) == 0 &&
        S_ISREG(mine.st_mode) && old.st_mode != mine.st_mode)
      if (fchmod(fileno(file_), old.st_mode & 07777) != 0) errno = 0;  // not ours: it stays new
  }
  if (!file_) throw_file_error(name_, "write");
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  // There was no commit(): the target stays as it was.
  std::fclose(file_);
  if (!neighbour_.empty()) std::remove(neighbour_.c_str());
}

void AtomicFile::write(const void* data, size_t bytes) {
  errno = 0;
  if (std::fwrite(data, 1, bytes, file_) != bytes) throw_file_error(name_, "write");
}

void AtomicFile::print(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  errno = 0;
  const int written = std::vfprintf(file_, format, arguments);
  va_end(arguments);
  if (written < 0) throw_file_error(name_, "write");
}

int AtomicFile::descriptor() const {
  if (neighbour_.empty()) throw Error(name_.string() + ": cannot write: not a regular file");
  return fileno(file_);
}

void AtomicFile::commit() {
  // The bytes are on the disk before the name points to them, and the name before commit() returns.
  sync_to_disk(file_, name_);
  close();
  if (neighbour_.empty()) return;
  if (std::rename(neighbour_.c_str(), target_.c_str()) != 0) {
    const int error = errno;
    std::remove(neighbour_.c_str());
    errno = error;
    throw_file_error(name_, "write");
  }
  sync_folder(target_.parent_path());
}

void AtomicFile::close() {
  errno = 0;
  if (std::fclose(std::exchange(file_, nullptr)) == 0) return;
  const int error = errno;
  if (!neighbour_.empty()) std::remove(neighbour_.c_str());
  errno = error;
  throw_file_error(name_, "write");
}

void write_whole_file(const fs::path& target, std::string_view text) {
  AtomicFile file(target);
  file.write(text);
  file.commit();
}

std::string read_whole_file(const fs::path& path) {
  errno = 0;
  // Without O_NONBLOCK a pipe would be waited for until somebody writes into it.
  const int descriptor = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) throw_file_error(path, "open");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(fdopen(descriptor, "rb"), std::fclose);
  if (!file) throw_file_error(path, "open");
  struct stat status;
  if (fstat(descriptor, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode))
    throw Error(
        path.string() + ": cannot read: it is a " +
        (S_ISFIFO(status.st_mode) ? "pipe, not a regular file" : "device, not a regular file"));
  std::string text;
  char block[1 << 16];
  size_t got;
  while ((got = std::fread(block, 1, sizeof block, file.get())) > 0) text.append(block, got);
  if (std::ferror(file.get())) throw_file_error(path, "read");
  return text;
}

void create_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(folder.string() + ": cannot make the folder: " + error.message());
  if (!is_folder(folder))
    throw Error(folder.string() + ": cannot make the folder: there is a file of that name");
}

void require_own_folder(const fs::path& folder, std::initializer_list<const char*> known) {
  std::error_code error;
  if (!is_folder(folder) || fs::is_empty(folder, error)) return;
  for (const char* name : known)
    if (is_folder(folder / name)) return;
  throw Error(folder.string() +
              ": holds files that are no results of this kind: give a folder that is new or empty");
}

namespace {

/// The file under that name is still the one that was opened: its last holder may have removed it
/// meanwhile.
bool is_current(int descriptor, const fs::path& file) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

bool briefly(double seconds_waited) { return seconds_waited < 3.0; }

FileLock::FileLock(fs::path file, const Patience& patience) : file_(std::move(file)) {
  constexpr double pause = 0.05;  // [s]
  for (double waited = 0.0; !try_once(); waited += pause) {
    if (!patience(waited)) return;
    usleep(static_cast<useconds_t>(1e6 * pause));
  }
}

bool FileLock::try_once() {
  const int descriptor = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) throw_file_error(file_, "make the lock");
  // Locked, but perhaps a file that its last holder has just unlinked: then try again.
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
    if (is_current(descriptor, file_)) {
      descriptor_ = descriptor;
      sign();
      return true;
    }
    close(descriptor);
    return false;
  }
  // Somebody else has it: read who signed it.
  const int error = errno;
  char text[160];
  const ssize_t length = pread(descriptor, text, sizeof text, 0);
  if (length > 0) holder_.assign(text, static_cast<size_t>(length));
  close(descriptor);
  errno = error;
  if (error != EWOULDBLOCK && error != EINTR) throw_file_error(file_, "lock");
  return false;
}

/// Only for whoever is turned away: that it cannot be written harms nobody.
void FileLock::sign() const {
  char host[65] = "";
  gethostname(host, sizeof host - 1);
  const std::string text = "process " + std::to_string(getpid()) + " on " + host;
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0)
    return;
}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  unlink(file_.c_str());  // while it is held
  close(descriptor_);
}

}  // namespace ballast
