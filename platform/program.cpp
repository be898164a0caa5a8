#include "platform/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "platform/error.hpp"

namespace ballast {
namespace {

using Clock = std::chrono::steady_clock;

std::vector<std::string> child_environment() {
  std::vector<std::string> variables{"LC_ALL=C"};
  for (char** entry = environ; *entry; ++entry) {
    const std::string variable = *entry;
    if (variable.rfind("LC_ALL=", 0) == 0 || variable.rfind("GNUPLOT", 0) == 0 ||
        variable.rfind("GNUTERM=", 0) == 0)
      continue;
    variables.push_back(variable);
  }
  return variables;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> result;
  for (std::string& s : strings) result.push_back(s.data());
  result.push_back(nullptr);
  return result;
}

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Error(std::string("cannot start a child process: ") + std::strerror(errno));
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    close(read_end);
    close_write_end();
  }
  void close_write_end() {
    if (write_end >= 0) close(write_end);
    write_end = -1;
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
};

/// Takes what is there; false when the other end has been closed.
bool take(int descriptor, std::string& text) {
  char block[1 << 16];
  const ssize_t got = read(descriptor, block, sizeof block);
  if (got > 0) text.append(block, static_cast<size_t>(got));
  return got > 0 || (got < 0 && errno == EINTR);
}

/// Reads both until the child closes them; false when time is up or it is too much.
bool read_both(const Pipe& output, const Pipe& errors, Clock::time_point deadline,
               ProgramResult& result) {
  constexpr size_t most = 256u << 20;
  pollfd waiting[2] = {{output.read_end, POLLIN, 0}, {errors.read_end, POLLIN, 0}};
  std::string* texts[2] = {&result.output, &result.errors};
  while (waiting[0].fd >= 0 || waiting[1].fd >= 0) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0 || result.output.size() + result.errors.size() > most) return false;
    if (poll(waiting, 2, static_cast<int>(std::min<long long>(left, 1000))) <= 0) continue;
    for (int k = 0; k < 2; ++k)
      if (waiting[k].fd >= 0 && waiting[k].revents != 0 && !take(waiting[k].fd, *texts[k]))
        waiting[k].fd = -1;
  }
  return true;
}

/// A child may close both and go on: still no waiting for ever.
int wait_for(pid_t child, Clock::time_point deadline, bool& timed_out) {
  int status = 0;
  for (;;) {
    const pid_t ended = waitpid(child, &status, timed_out ? 0 : WNOHANG);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR) return 127;
    if (ended == 0 && Clock::now() > deadline) {
      timed_out = true;
      kill(child, SIGKILL);
    } else if (ended == 0) {
      usleep(1000);
    }
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

ProgramResult run_child(const std::string& program, const std::vector<std::string>& arguments,
                        double seconds) {
  Pipe output, errors;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output.write_end, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors.write_end, STDERR_FILENO);
  std::vector<std::string> words{program}, environment = child_environment();
  words.insert(words.end(), arguments.begin(), arguments.end());
  pid_t child = 0;
  const int error = posix_spawnp(&child, program.c_str(), &actions, nullptr, pointers(words).data(),
                                 pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  output.close_write_end();
  errors.close_write_end();
  ProgramResult result;
  if (error != 0) {
    result.was_found = false;
    result.status = 127;
    result.errors = std::strerror(error);
    return result;
  }
  const auto deadline =
      Clock::now() + std::chrono::milliseconds(static_cast<long long>(1e3 * seconds));
  if (!read_both(output, errors, deadline, result)) {
    result.timed_out = true;
    kill(child, SIGKILL);
  }
  result.status = wait_for(child, deadline, result.timed_out);
  return result;
}

}  // namespace ballast
