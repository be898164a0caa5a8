#include "platform/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "platform/clock.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace {

[[noreturn]] void throw_no_child() {
  throw Error(std::string("cannot start a child process: ") + std::strerror(errno));
}

/// In the pipe:   | mark | length | the answer | mark |   A child that dies on the way leaves less.
/// Before the answer: that it follows, and its length. After it: the same word once more.
struct Head {
  std::uint64_t word;
  std::uint64_t length;
};
constexpr std::uint64_t mark = 0x62616c6c61737421ull;

bool expendable = false;

bool write_all(int pipe, const void* data, size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(pipe, next, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    next += written;
    size -= static_cast<size_t>(written);
  }
  return true;
}

/// In the child: the answer goes into the pipe, everything that is printed nowhere.
void answer_into(int pipe, const std::function<std::string()>& work) {
  expendable = true;
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const std::string answer = work();
  const Head head{mark, answer.size()};
  const bool is_whole = write_all(pipe, &head, sizeof head) &&
                        write_all(pipe, answer.data(), answer.size()) &&
                        write_all(pipe, &mark, sizeof mark);
  _exit(is_whole ? 0 : 1);
}

/// What stands between the two marks; false when something is missing.
bool take_answer(const std::string& bytes, std::string& answer) {
  Head head;
  std::uint64_t last;
  if (bytes.size() < sizeof head + sizeof last) return false;
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.word != mark || bytes.size() - sizeof head - sizeof last != head.length) return false;
  std::memcpy(&last, bytes.data() + bytes.size() - sizeof last, sizeof last);
  if (last != mark) return false;
  answer = bytes.substr(sizeof head, head.length);
  return true;
}

}  // namespace

bool is_expendable_process() { return expendable; }

ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work) {
  Pipe pipe;
  const ChildProcess child([&] { answer_into(pipe.write_end(), work); });
  pipe.close_write_end();
  const bool is_closed =
      Pipe::read_until_closed({&pipe}, max_seconds, std::numeric_limits<size_t>::max());
  // The child is killed below, which is harmless when it is through: it has written, and is about
  // to leave.
  ChildResult result;
  if (take_answer(pipe.text, result.answer))
    result.end = ChildEnd::complete;
  else
    result.end = is_closed ? ChildEnd::crashed : ChildEnd::out_of_time;
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

Pipe::Pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw_no_child();
  read_end_ = ends[0];
  write_end_ = ends[1];
}

Pipe::~Pipe() {
  close(read_end_);
  close_write_end();
}

void Pipe::close_write_end() {
  if (write_end_ >= 0) close(write_end_);
  write_end_ = -1;
}

/// Takes what is there; false when the other end has been closed.
bool Pipe::take() {
  char block[1 << 16];
  const ssize_t got = read(read_end_, block, sizeof block);
  if (got > 0) text.append(block, static_cast<size_t>(got));
  return got > 0 || (got < 0 && errno == EINTR);
}

bool Pipe::read_until_closed(std::initializer_list<Pipe*> pipes, double max_seconds,
                             size_t most_bytes) {
  const Stopwatch watch;
  std::vector<Pipe*> open(pipes);
  std::vector<pollfd> waiting;
  while (!open.empty()) {
    const double left = max_seconds - watch.seconds();
    size_t bytes = 0;
    for (const Pipe* pipe : pipes) bytes += pipe->text.size();
    if (!(left > 0.0) || bytes > most_bytes) return false;
    // Wait until one of them has something or is closed, and read what there is.
    waiting.clear();
    for (const Pipe* pipe : open) waiting.push_back({pipe->read_end_, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(),
             static_cast<int>(std::ceil(std::min(1e3 * left, 1e6)))) <= 0)
      continue;
    for (size_t k = open.size(); k-- > 0;)
      if (waiting[k].revents != 0 && !open[k]->take())
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return true;
}

}  // namespace ballast
