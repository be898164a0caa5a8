#include "platform/child_process.hpp"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace ballast {
namespace {

using Clock = std::chrono::steady_clock;

/// Before the answer: a word that says that it follows, and its size in bytes. After it: the same
/// word once more.
struct Head {
  std::uint64_t word;
  std::uint64_t size;
};
constexpr std::uint64_t mark = 0x62616c6c61737421ull;

bool write_all(int pipe, const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(pipe, next, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    next += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

/// Never returns: the parent's destructors, exit handlers and unwritten output are not the child's.
[[noreturn]] void be_child(int pipe, pid_t parent, const std::function<std::string()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  for (const int number : {SIGINT, SIGTERM, SIGABRT, SIGSEGV, SIGFPE}) signal(number, SIG_DFL);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  std::string answer;
  try {
    answer = work();
  } catch (...) {
    _exit(1);
  }
  const Head head{mark, answer.size()};
  const bool whole = write_all(pipe, &head, sizeof head) &&
                     write_all(pipe, answer.data(), answer.size()) &&
                     write_all(pipe, &mark, sizeof mark);
  _exit(whole ? 0 : 1);
}

/// Reads until the other end is closed; false when the time is over first.
bool read_until_closed(int pipe, Clock::time_point begin, double max_seconds, std::string& bytes) {
  char buffer[65536];
  for (;;) {
    const double left = max_seconds - std::chrono::duration<double>(Clock::now() - begin).count();
    if (left <= 0.0) return false;
    pollfd waited{pipe, POLLIN, 0};
    const int wait_ms = left < 1e6 ? static_cast<int>(std::ceil(left * 1e3)) : -1;
    const int ready = poll(&waited, 1, wait_ms);
    if (ready < 0 && errno != EINTR) return true;
    if (ready <= 0) continue;
    const ssize_t count = read(pipe, buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return true;
    bytes.append(buffer, static_cast<std::size_t>(count));
  }
}

/// The answer between head and last word; false when something of it is missing.
bool take_answer(const std::string& bytes, std::string& answer) {
  Head head;
  std::uint64_t last;
  if (bytes.size() < sizeof head + sizeof last) return false;
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.word != mark || bytes.size() != sizeof head + head.size + sizeof last) return false;
  std::memcpy(&last, bytes.data() + bytes.size() - sizeof last, sizeof last);
  if (last != mark) return false;
  answer = bytes.substr(sizeof head, head.size);
  return true;
}

}  // namespace

ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work) {
  const Clock::time_point begin = Clock::now();
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
  const pid_t parent = getpid(), child = fork();
  if (child < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    throw std::runtime_error(std::string("fork: ") + std::strerror(error));
  }
  if (child == 0) {
    close(ends[0]);
    be_child(ends[1], parent, work);
  }
  close(ends[1]);
  std::string bytes;
  const bool closed = read_until_closed(ends[0], begin, max_seconds, bytes);
  close(ends[0]);
  // Harmless for a child that is through: it has written, and is about to exit or already waits to
  // be collected.
  kill(child, SIGKILL);
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  ChildResult result;
  if (take_answer(bytes, result.answer))
    result.end = ChildEnd::complete;
  else
    result.end = closed ? ChildEnd::crashed : ChildEnd::out_of_time;
  return result;
}

}  // namespace ballast
