#include "platform/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// How many threads OpenBLAS and OpenMP take. CHOLMOD asks for four whatever the second says: they
/// wait for each other, spinning, wherever another program has a core. The third forbids it.
constexpr const char* algebra_threads[] = {"OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS",
                                           "OMP_THREAD_LIMIT"};

/// A program, its arguments and its environment as exec wants them: made before the fork, after
/// which no memory may be asked for when there are threads.
class Call {
 public:
  Call(const std::string& program, const std::vector<std::string>& arguments,
       std::vector<std::string> environment)
      : words_{program}, environment_(std::move(environment)) {
    words_.insert(words_.end(), arguments.begin(), arguments.end());
    for (std::string& word : words_) word_pointers_.push_back(word.data());
    for (std::string& variable : environment_) variable_pointers_.push_back(variable.data());
    word_pointers_.push_back(nullptr);
    variable_pointers_.push_back(nullptr);
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// In the child: becomes the program, with standard input empty. Returns errno when it cannot.
  int execute(int output, int errors) const {
    dup2(open("/dev/null", O_RDONLY | O_CLOEXEC), STDIN_FILENO);
    dup2(output, STDOUT_FILENO);
    dup2(errors, STDERR_FILENO);
    execvpe(word_pointers_[0], word_pointers_.data(), variable_pointers_.data());
    return errno;
  }

 private:
  std::vector<std::string> words_, environment_;
  std::vector<char*> word_pointers_, variable_pointers_;
};

/// Ours, with nothing that changes what gnuplot writes.
std::vector<std::string> plain_environment() {
  std::vector<std::string> variables{"LC_ALL=C"};
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view variable = *entry;
    if (!variable.starts_with("LC_ALL=") && !variable.starts_with("GNUPLOT") &&
        !variable.starts_with("GNUTERM="))
      variables.emplace_back(variable);
  }
  return variables;
}

std::vector<std::string> environment_with_one_algebra_thread() {
  std::vector<std::string> variables;
  for (char** entry = environ; *entry; ++entry) variables.emplace_back(*entry);
  for (const std::string name : algebra_threads)
    if (!getenv(name.c_str())) variables.push_back(name + "=1");
  return variables;
}

/// A log to append to; closed with it.
struct Log {
  explicit Log(const fs::path& file)
      : descriptor(open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666)) {
    if (descriptor < 0) throw_file_error(file, "open");
  }
  ~Log() { close(descriptor); }
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;
  const int descriptor;
};

ChildProcess start_beside(const fs::path& program, const std::vector<std::string>& arguments,
                          const fs::path& file) {
  const Log log(file);
  const Call call(program.string(), arguments, environment_with_one_algebra_thread());
  return ChildProcess([&] {
    setpgid(0, 0);
    const int error = call.execute(log.descriptor, log.descriptor);
    dprintf(STDERR_FILENO, "ballast: %s: cannot be started: %s\n", program.c_str(),
            std::strerror(error));
    _exit(127);
  });
}

}  // namespace

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          double seconds) {
  constexpr rlim_t most_bytes = 256u << 20;
  const MemoryFile output, errors, failure;  // failure: why the program could not be started
  const Call call(program, arguments, plain_environment());
  ChildProcess child([&] {
    const rlimit limit{most_bytes, most_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    const int error = call.execute(output.descriptor(), errors.descriptor());
    dprintf(failure.descriptor(), "%s", std::strerror(error));
    _exit(127);
  });
  ProgramResult result;
  result.timed_out = !child.ends_within(seconds);
  child.send(SIGKILL);
  child.ends_within(1e9);
  result.status = child.status();
  result.errors = failure.text();
  result.was_found = result.errors.empty();
  if (!result.was_found) return result;
  result.output = output.text();
  result.errors = errors.text();
  return result;
}

BackgroundProgram::BackgroundProgram(const fs::path& program,
                                     const std::vector<std::string>& arguments, const fs::path& log)
    : child_(start_beside(program, arguments, log)) {}

void BackgroundProgram::stop() const { child_.send(SIGTERM); }

// ---- somebody else's program

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

/// The kernel lists them, each followed by a blank; what does not fit is met in the next round.
void kill_own_children() {
  char list[4096];
  const int file = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
  const ssize_t size = read(file, list, sizeof list - 1);
  close(file);
  list[std::max<ssize_t>(size, 0)] = '\0';
  char* end = list;
  for (char* next = list; *next != '\0'; next = end + 1) {
    const long child = std::strtol(next, &end, 10);
    if (end == next || *end != ' ') return;
    kill(static_cast<pid_t>(child), SIGKILL);
  }
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
  supervisor_->send(SIGTERM);
  supervisor_->ends_within(10.0);
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

// ---- words and this program

std::string last_line(const fs::path& log) {
  std::ifstream stream(log);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  constexpr std::string_view prefix = "ballast: ";
  return last.starts_with(prefix) ? last.substr(prefix.size()) : last;
}

std::string shell_word(const std::string& word) {
  const bool is_plain =
      !word.empty() &&
      word.find_first_not_of(
          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+:,@%") ==
          std::string::npos;
  if (is_plain) return word;
  // Within single quotes a shell takes everything as it is but the quote itself, which
  // is put in from outside of them.
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += shell_word(word);
  }
  return line;
}

fs::path own_program() { return fs::read_symlink("/proc/self/exe"); }

std::vector<std::string> own_words() {
  std::vector<std::string> words;
  const std::string text = read_whole_file("/proc/self/cmdline");
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\0', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

void restart_with_one_algebra_thread() {
  std::vector<std::string> words = own_words();
  if (std::ranges::all_of(algebra_threads, getenv) || words.empty()) return;
  for (const char* name : algebra_threads) setenv(name, "1", 0);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv("/proc/self/exe", pointers.data());
  throw Error("cannot start anew with OPENBLAS_NUM_THREADS=1");
}

}  // namespace ballast
