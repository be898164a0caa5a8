#include "platform/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "platform/clock.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

[[noreturn]] void throw_no_child() {
  throw Error(std::string("cannot start a child process: ") + std::strerror(errno));
}

/// Before the answer: that it is whole, and its length. It is written last, so that a child that
/// dies on the way leaves less.
struct Head {
  std::uint64_t mark, length;
};
constexpr std::uint64_t whole = 0x62616c6c61737421ull;

bool expendable = false;

bool write_at(int file, off_t offset, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file, bytes.data(), bytes.size(), offset);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    offset += written;
    bytes.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

/// In the child: the answer goes into the file, everything that is printed nowhere.
void answer_into(int file, const std::function<std::string()>& work) {
  expendable = true;
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const std::string answer = work();
  const Head head{whole, answer.size()};
  const bool is_written = write_at(file, sizeof head, answer) &&
                          write_at(file, 0, {reinterpret_cast<const char*>(&head), sizeof head});
  _exit(is_written ? 0 : 1);
}

}  // namespace

bool is_expendable_process() { return expendable; }

ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work) {
  const MemoryFile file;
  ChildProcess child([&] { answer_into(file.descriptor(), work); });
  ChildResult result;
  if (!child.ends_within(max_seconds)) {
    result.end = ChildEnd::out_of_time;
    return result;  // and is killed
  }
  std::string bytes = file.text();
  Head head{};
  if (bytes.size() < sizeof head) return result;
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.mark != whole || bytes.size() - sizeof head != head.length) return result;
  result.end = ChildEnd::complete;
  result.answer = bytes.substr(sizeof head);
  return result;
}

ChildProcess::ChildProcess(const std::function<void()>& live) {
  const pid_t parent = getpid();
  // From here on two processes run; the child never leaves this constructor.
  child_ = fork();
  if (child_ < 0) throw_no_child();
  if (child_ > 0) return;
  // The kernel kills the child when its parent dies, whatever the parent dies of.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGPIPE, SIGABRT, SIGSEGV, SIGFPE})
    signal(number, SIG_DFL);
  try {
    live();
  } catch (...) {
  }
  _exit(1);
}

ChildProcess::~ChildProcess() {
  send(SIGKILL);
  collect(true);
}

void ChildProcess::send(int signal) const {
  if (child_ > 0) kill(child_, signal);
}

bool ChildProcess::collect(bool waits) {
  if (child_ < 0) return true;
  int status = 0;
  pid_t ended;
  do ended = waitpid(child_, &status, waits ? 0 : WNOHANG);
  while (ended < 0 && errno == EINTR);
  if (ended == 0) return false;
  child_ = -1;
  if (ended < 0)
    status_ = 127;  // somebody else waited for it
  else
    status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

bool ChildProcess::ends_within(double seconds) {
  const Stopwatch watch;
  for (useconds_t pause = 50; !has_ended(); pause = std::min<useconds_t>(2 * pause, 1000)) {
    if (!(watch.seconds() < seconds)) return false;
    usleep(pause);
  }
  return true;
}

MemoryFile::MemoryFile() : descriptor_(memfd_create("ballast", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw_no_child();
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::string MemoryFile::text() const {
  const off_t size = lseek(descriptor_, 0, SEEK_END);
  std::string text(size > 0 ? static_cast<size_t>(size) : 0, '\0');
  for (size_t at = 0; at < text.size();) {
    const ssize_t got =
        pread(descriptor_, text.data() + at, text.size() - at, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    at += static_cast<size_t>(got);
  }
  return text;
}

}  // namespace ballast
