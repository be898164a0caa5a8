#include "platform/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "platform/atomic_file.hpp"

namespace ballast {
namespace {

/// The file under that name is still the one that was opened: its last holder may have removed it
/// meanwhile.
bool is_current(int descriptor, const std::filesystem::path& file) {
  struct stat opened {
  }, named{};
  return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

bool briefly(double seconds_waited) { return seconds_waited < 3.0; }

FileLock::FileLock(std::filesystem::path file, const Patience& patience) : file_(std::move(file)) {
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
