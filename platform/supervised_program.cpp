#include "platform/supervised_program.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"

namespace ballast {
namespace {

constexpr size_t longest_line = 4096, longest_complaint = 8192;  // bytes that are kept

/// Two ends of a connection: what is written to one is read at the other.
struct Ends {
  int ours = -1, theirs = -1;
};

/// Sockets, because writing to one that nobody reads is an error here and not a signal.
Ends connect_ends() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    throw Error(std::string("cannot start a program: ") + std::strerror(errno));
  return {ends[0], ends[1]};
}

/// The parent of a process as /proc/<id>/stat says it; -1 for what is no process.
pid_t parent_of(const char* id) {
  char path[64], text[512];
  std::snprintf(path, sizeof path, "/proc/%.20s/stat", id);
  const int file = open(path, O_RDONLY | O_CLOEXEC);
  if (file < 0) return -1;
  const ssize_t size = read(file, text, sizeof text - 1);
  close(file);
  if (size <= 0) return -1;
  text[size] = '\0';
  // "12 (name, which may hold anything) S 7 ...": the state and the parent stand behind the name.
  const char* name_end = std::strrchr(text, ')');
  if (!name_end || std::strlen(name_end) < 5) return -1;
  return static_cast<pid_t>(std::atol(name_end + 4));
}

void kill_own_children() {
  DIR* processes = opendir("/proc");
  if (!processes) return;
  const pid_t own = getpid();
  while (const dirent* entry = readdir(processes))
    if (entry->d_name[0] >= '1' && entry->d_name[0] <= '9' && parent_of(entry->d_name) == own)
      kill(static_cast<pid_t>(std::atol(entry->d_name)), SIGKILL);
  closedir(processes);
}

/// In the supervisor, to which every orphan of the program falls: until there is none left.
void end_descendants(pid_t program) {
  kill(-program, SIGKILL);
  for (;;) {
    const pid_t ended = waitpid(-1, nullptr, WNOHANG);
    if (ended < 0 && errno == ECHILD) return;
    if (ended > 0) continue;
    kill_own_children();
    waitpid(-1, nullptr, 0);
  }
}

struct Start {
  const char* const* words;
  const SupervisedLimits& limits;
  Ends input, output, errors;
};

/// In the program's process.
[[noreturn]] void become_program(const Start& start) {
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (start.limits.memory_MB > 0.0) {
    const auto bytes = static_cast<rlim_t>(start.limits.memory_MB * 1048576.0);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_AS, &limit);
  }
  dup2(start.input.theirs, STDIN_FILENO);
  dup2(start.output.theirs, STDOUT_FILENO);
  dup2(start.errors.theirs, STDERR_FILENO);
  if (start.limits.folder.empty() || chdir(start.limits.folder.c_str()) == 0)
    execv(start.words[0], const_cast<char* const*>(start.words));
  dprintf(STDERR_FILENO, "cannot be started: %s\n", std::strerror(errno));
  _exit(127);
}

/// In the supervisor: ends with the program's status when that ends, and when it is asked to.
[[noreturn]] void supervise(const Start& start) {
  sigset_t awaited;
  sigemptyset(&awaited);
  sigaddset(&awaited, SIGCHLD);
  sigaddset(&awaited, SIGTERM);
  sigprocmask(SIG_BLOCK, &awaited, nullptr);
  signal(SIGCHLD, SIG_DFL);
  // Out of reach of the terminal's Ctrl-C; told when our parent dies; adopts who loses a parent.
  setsid();
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t program = fork();
  if (program < 0) _exit(127);
  if (program == 0) become_program(start);
  setpgid(program, program);
  // No end of the program's streams may stay open here: nobody would see that it closed them.
  close_range(0, ~0U, 0);
  int status = 128 + SIGKILL;
  for (bool goes_on = true; goes_on;) {
    if (sigwaitinfo(&awaited, nullptr) == SIGTERM) break;
    int how = 0;
    for (pid_t ended; (ended = waitpid(-1, &how, WNOHANG)) > 0;) {
      if (ended != program) continue;
      status = WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how);
      goes_on = false;
    }
  }
  end_descendants(program);
  _exit(status);
}

/// Takes what is there, at most once; false when the other end has been closed.
bool take(int descriptor, std::string& text) {
  char block[1 << 16];
  const ssize_t got = read(descriptor, block, sizeof block);
  if (got > 0) text.append(block, static_cast<size_t>(got));
  return got > 0 || (got < 0 && (errno == EINTR || errno == EAGAIN));
}

void close_end(int& descriptor) {
  if (descriptor >= 0) close(descriptor);
  descriptor = -1;
}

}  // namespace

SupervisedProgram::SupervisedProgram(const std::string& command,
                                     const std::vector<std::string>& arguments,
                                     const SupervisedLimits& limits) {
  // All memory is asked for before the fork.
  const std::string script = command + " \"$@\"";
  std::vector<const char*> words{"/bin/sh", "-c", script.c_str(), "sh"};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  words.push_back(nullptr);
  const Start start{words.data(), limits, connect_ends(), connect_ends(), connect_ends()};
  input_ = start.input.ours;
  output_ = start.output.ours;
  errors_ = start.errors.ours;
  // Asked to end before it is ready to hear that, the supervisor shall hear it then.
  sigset_t ending, before;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &ending, &before);
  supervisor_ = std::make_unique<ChildProcess>([&] { supervise(start); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  for (int end : {start.input.theirs, start.output.theirs, start.errors.theirs}) close_end(end);
}

SupervisedProgram::~SupervisedProgram() {
  // The supervisor clears up; if even it does not end, ChildProcess kills it.
  constexpr double patience = 10.0;
  supervisor_->send(SIGTERM);
  const Stopwatch watch;
  while (!supervisor_->has_ended() && watch.seconds() < patience) usleep(200);
  close_input();
  close_end(output_);
  close_end(errors_);
}

bool SupervisedProgram::write_line(const std::string& line) const {
  const std::string text = line + '\n';
  return input_ >= 0 && send(input_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
                            static_cast<ssize_t>(text.size());
}

void SupervisedProgram::close_input() { close_end(input_); }

/// Waits until it says something, and takes that; false when it has closed both of its streams.
bool SupervisedProgram::listen(double seconds) {
  pollfd waiting[] = {{output_, POLLIN, 0}, {errors_, POLLIN, 0}};
  if (output_ < 0 && errors_ < 0) return false;
  poll(waiting, 2, static_cast<int>(std::ceil(1e3 * std::clamp(seconds, 0.0, 0.1))));
  if (waiting[0].revents != 0 && !take(output_, heard_)) close_end(output_);
  if (waiting[1].revents != 0 && !take(errors_, complaints_)) close_end(errors_);
  if (complaints_.size() > longest_complaint)
    complaints_.erase(0, complaints_.size() - longest_complaint);
  return true;
}

SupervisedProgram::Heard SupervisedProgram::read_line(std::string& line, double seconds) {
  const Stopwatch watch;
  for (;;) {
    if (const size_t end = heard_.find('\n'); end != std::string::npos) {
      line = heard_.substr(0, std::min(end, longest_line));
      heard_.erase(0, end + 1);
      return Heard::line;
    }
    // A line without end: only its beginning will be asked for.
    if (heard_.size() > longest_line) heard_.resize(longest_line);
    if (output_ < 0) return Heard::end;
    const double left = seconds - watch.seconds();
    if (!(left > 0.0) || InterruptGuard::requested()) return Heard::out_of_time;
    listen(left);
  }
}

bool SupervisedProgram::wait(double seconds) {
  constexpr int pause = 200;  // microseconds
  const Stopwatch watch;
  while (!supervisor_->has_ended()) {
    const double left = seconds - watch.seconds();
    if (!(left > 0.0) || InterruptGuard::requested()) return false;
    // It may close its streams and go on.
    if (!listen(left)) usleep(pause);
    heard_.clear();
  }
  // What it said before it ended.
  for (pollfd last{errors_, POLLIN, 0}; errors_ >= 0 && poll(&last, 1, 0) > 0;) listen(0.0);
  return true;
}

std::string SupervisedProgram::last_words() const {
  const size_t end = complaints_.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return "";
  const size_t before = complaints_.find_last_of("\r\n", end);
  const size_t begin = before == std::string::npos ? 0 : before + 1;
  return complaints_.substr(begin, std::min(end + 1 - begin, size_t{200}));
}

}  // namespace ballast
