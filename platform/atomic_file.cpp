#include "platform/atomic_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
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

/// The regular file, existing or not, that a name leads to; symbolic links are followed one by one.
/// Empty where the name must be written directly: devices, pipes, and links that pass through
/// /proc, as /dev/stdout does: a file that another process has open must not be replaced.
fs::path replaceable(const fs::path& name) {
  fs::path file = name;
  std::error_code error;
  constexpr int most_links = 40;  // as many as the kernel follows
  for (int link = 0; link < most_links && fs::is_symlink(file, error); ++link) {
    file = file.parent_path() / fs::read_symlink(file, error);
    if (file.lexically_normal().string().starts_with("/proc/")) return {};
  }
  // A cycle of links leads to no file: opening it reports that.
  const fs::file_type kind = fs::status(file, error).type();
  return kind == fs::file_type::regular || kind == fs::file_type::not_found ? file : fs::path();
}

const std::string signature = "process ";

/// True for the text of a lock. A lock that has just been made is not signed yet.
bool is_lock_text(std::string_view text) { return text.empty() || text.starts_with(signature); }

bool is_lock(const fs::path& file) {
  return file.extension() == ".lock" && is_file(file) && is_lock_text(read_whole_file(file));
}

/// True where the file under that name is still the one that was opened: the last holder of the
/// lock may have removed it meanwhile.
bool is_current(int descriptor, const fs::path& file) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : name_(std::move(target)), target_(replaceable(name_)) {
  // Written beside the target and renamed over it: readers see the old file or the new one, whole.
  if (!target_.empty()) neighbour_ = target_.string() + ".tmp";
  errno = 0;
  file_ = target_.empty() ? std::fopen(name_.c_str(), "wb") : std::fopen(neighbour_.c_str(), "w+b");
  if (!file_) throw_file_error(name_, "write");
  // The target's permissions are kept; where we may not set them, the new ones stay. A neighbour
  // that leads to a device stays as it is.
  struct stat old, mine;
  if (!target_.empty() && stat(target_.c_str(), &old) == 0 && fstat(fileno(file_), &mine) == 0 &&
      S_ISREG(mine.st_mode) && fchmod(fileno(file_), old.st_mode & 07777) != 0)
    errno = 0;
}

AtomicFile::~AtomicFile() {
  if (file_) std::fclose(file_);
  if (!neighbour_.empty()) std::remove(neighbour_.c_str());
}

void AtomicFile::write(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), file_) != text.size())
    throw_file_error(name_, "write");
}

int AtomicFile::descriptor() const {
  if (neighbour_.empty()) throw Error(name_.string() + ": cannot write: not a regular file");
  return fileno(file_);
}

void AtomicFile::commit() {
  // The bytes are on the disk before the name points to them, and the name before commit() returns.
  sync_to_disk(file_, name_);
  if (std::fclose(std::exchange(file_, nullptr)) != 0) throw_file_error(name_, "write");
  if (neighbour_.empty()) return;
  if (std::rename(neighbour_.c_str(), target_.c_str()) != 0) throw_file_error(name_, "write");
  neighbour_.clear();
  sync_folder(target_.parent_path());
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

void require_own_folder(const fs::path& folder, std::initializer_list<OwnMark> known) {
  for (const auto& [name, words] : known) {
    const fs::path mark = folder / name;
    if (words ? is_file(mark) && read_whole_file(mark).find(words) != std::string::npos
              : is_folder(mark))
      return;
  }
  if (!is_folder(folder)) return;
  // A process killed before its first file is whole leaves folders, a .tmp file and a lock.
  constexpr auto skipping = fs::directory_options::skip_permission_denied;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, skipping))
    if (!fs::is_directory(entry.symlink_status()) && entry.path().extension() != ".tmp" &&
        !is_lock(entry.path()))
      throw Error(folder.string() +
                  ": holds files that are no results of this kind: give a "
                  "folder that is new or empty");
}

bool briefly(double seconds_waited) { return seconds_waited < 3.0; }

FileLock::FileLock(fs::path file, const Patience& patience) : file_(std::move(file)) {
  constexpr double pause = 0.05;  // [s]
  for (double waited = 0.0; !try_once(); waited += pause) {
    if (!patience(waited)) return;
    usleep(static_cast<useconds_t>(1e6 * pause));
  }
  // The signature only informs those who are turned away: failing to write it does no harm.
  char host[65] = "";
  gethostname(host, sizeof host - 1);
  const std::string text = signature + std::to_string(getpid()) + " on " + host;
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0)
    return;
}

bool FileLock::try_once() {
  const int descriptor = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) throw_file_error(file_, "make the lock");
  const bool is_locked = flock(descriptor, LOCK_EX | LOCK_NB) == 0;
  // Either somebody else holds it: read who signed it. Or it was unlinked meanwhile: try again.
  const int error = is_locked ? EWOULDBLOCK : errno;
  char text[160];
  const ssize_t length = pread(descriptor, text, sizeof text, 0);
  const std::string_view words(text, static_cast<size_t>(std::max<ssize_t>(length, 0)));
  const bool is_ours = is_lock_text(words);
  if (is_ours && is_locked && is_current(descriptor, file_)) {
    descriptor_ = descriptor;
    return true;
  }
  close(descriptor);
  if (!is_ours) throw Error(file_.string() + ": cannot make the lock: it is somebody's file");
  if (!words.empty()) holder_ = words;
  errno = error;
  if (error != EWOULDBLOCK && error != EINTR) throw_file_error(file_, "lock");
  return false;
}

void FileLock::require_held() const {
  if (!is_held()) throw Error(file_.parent_path().string() + ": " + holder_ + " is working there");
}

FileLock::~FileLock() {
  if (descriptor_ < 0) return;
  unlink(file_.c_str());  // while it is held
  close(descriptor_);
}

}  // namespace ballast
