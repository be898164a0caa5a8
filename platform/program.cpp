#include "platform/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/mman.h>
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
#include <initializer_list>
#include <string_view>
#include <utility>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void throw_no_child() {
  throw Error(std::string("cannot start a child process: ") + std::strerror(errno));
}

/// Owns a descriptor and closes it; other programs do not inherit it. Throws Error when there is
/// none.
struct Descriptor {
  explicit Descriptor(int opened) : number(opened) {
    if (number < 0) throw_no_child();
  }
  ~Descriptor() { close(number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  const int number;
};

/// A file in memory that a child writes into and that is read here when the child has ended.
struct MemoryFile : Descriptor {
  MemoryFile() : Descriptor(memfd_create("ballast", MFD_CLOEXEC)) {}

  /// All that has been written.
  std::string text() const {
    std::string text(static_cast<size_t>(std::max<off_t>(lseek(number, 0, SEEK_END), 0)), '\0');
    const ssize_t got = pread(number, text.data(), text.size(), 0);
    text.resize(static_cast<size_t>(std::max<ssize_t>(got, 0)));
    return text;
  }
};

/// The status as a shell reports it, from waitpid()'s `how`.
int status_of(int how) { return WIFEXITED(how) ? WEXITSTATUS(how) : 128 + WTERMSIG(how); }

/// Ends an answer or the words of an exception: a child that dies on the way leaves less.
constexpr std::string_view whole_answer = "\x1bwhole answer\x1b", whole_words = "\x1bits words\x1b";

bool expendable = false;

/// Runs in the child: writes its answer, or why it has none, and discards all that is printed.
void answer_into(int file, const std::function<std::string()>& work) {
  expendable = true;
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  std::string answer;
  try {
    answer = work().append(whole_answer);
  } catch (const std::exception& error) {
    answer = std::string(error.what()).append(whole_words);
  }
  _exit(write(file, answer.data(), answer.size()) == static_cast<ssize_t>(answer.size()) ? 0 : 1);
}

}  // namespace

bool is_expendable_process() { return expendable; }

ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work,
                         const std::function<bool()>& is_cancelled) {
  const MemoryFile file;
  ChildProcess child([&] { answer_into(file.number, work); });
  const Stopwatch watch;
  const double pause = is_cancelled ? 0.05 : max_seconds;
  while (!child.ends_within(std::min(pause, max_seconds - watch.seconds())))
    if (watch.has_passed(max_seconds) || (is_cancelled && is_cancelled()))
      return {ChildEnd::out_of_time, ""};  // the destructor kills the child
  std::string answer = file.text();
  for (const auto& [end, mark] :
       {std::pair(ChildEnd::complete, whole_answer), {ChildEnd::failed, whole_words}})
    if (answer.ends_with(mark)) {
      answer.resize(answer.size() - mark.size());
      return {end, std::move(answer)};
    }
  return {ChildEnd::crashed, ""};
}

ChildProcess::ChildProcess(const std::function<void()>& live) {
  const pid_t parent = getpid();
  // A signal to the child waits until our handlers are gone there: they would swallow it.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  // From here on two processes run; the child never leaves this constructor.
  child_ = fork();
  if (child_ != 0) pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child_ < 0) throw_no_child();
  if (child_ > 0) return;
  // The kernel kills the child when its parent dies, whatever the parent dies of.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  for (const int number :
       {SIGINT, SIGTERM, SIGHUP, SIGUSR1, SIGPIPE, SIGCHLD, SIGABRT, SIGSEGV, SIGFPE})
    signal(number, SIG_DFL);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
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
  int how = 0;
  pid_t ended;
  do ended = waitpid(child_, &how, waits ? 0 : WNOHANG);
  while (ended < 0 && errno == EINTR);
  if (ended == 0) return false;
  child_ = -1;
  status_ = ended < 0 ? 127 : status_of(how);  // 127: somebody else waited for it
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

// ---- other programs

namespace {

/// Limits OpenBLAS and OpenMP to one thread. CHOLMOD asks for four whatever the second says: they
/// spin, waiting for each other, wherever another program has a core. The third forbids it.
constexpr const char* one_algebra_thread[] = {"OPENBLAS_NUM_THREADS=1", "OMP_NUM_THREADS=1",
                                              "OMP_THREAD_LIMIT=1"};

/// Words or variables as exec takes them, ended by a null. They are made before the fork: when
/// there are threads, no memory may be allocated after it. They point into their sources.
using Words = std::vector<const char*>;

Words words_of(Words words, const std::vector<std::string>& arguments) {
  for (const std::string& word : arguments) words.push_back(word.c_str());
  words.push_back(nullptr);
  return words;
}

/// Our environment without the variables that begin with one of `dropped`, and with `added`.
Words changed_environment(std::initializer_list<std::string_view> dropped, Words added) {
  for (char** entry = environ; *entry; ++entry) {
    const std::string_view variable = *entry;
    if (std::ranges::none_of(dropped, [&](auto begin) { return variable.starts_with(begin); }))
      added.push_back(*entry);
  }
  added.push_back(nullptr);
  return added;
}

/// The variables of one_algebra_thread that our environment does not set.
Words unsaid_threads() {
  Words unsaid;
  for (const std::string_view variable : one_algebra_thread)
    if (!getenv(std::string(variable.substr(0, variable.find('='))).c_str()))
      unsaid.push_back(variable.data());
  return unsaid;
}

/// Runs in the child: becomes the program. Returns when it cannot, with errno.
void become(const Words& words, const Words& environment, int input, int output, int errors) {
  dup2(input, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  execvpe(words[0], const_cast<char* const*>(words.data()),
          const_cast<char* const*>(environment.data()));
}

int nothing_to_read() { return open("/dev/null", O_RDONLY | O_CLOEXEC); }

}  // namespace

ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          double seconds) {
  constexpr rlim_t most_bytes = 256u << 20;
  const MemoryFile output, errors;
  // The environment has nothing that changes the output of gnuplot.
  const Words words = words_of({program.c_str()}, arguments),
              environment = changed_environment({"LC_ALL=", "GNUPLOT", "GNUTERM="}, {"LC_ALL=C"});
  ChildProcess child([&] {
    const rlimit limit{most_bytes, most_bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
    become(words, environment, nothing_to_read(), output.number, errors.number);
    dprintf(STDERR_FILENO, "cannot be started: %s", std::strerror(errno));
    _exit(127);
  });
  const bool timed_out = !child.ends_within(seconds);
  child.send(SIGKILL);
  child.ends_within(1e9);
  return {timed_out, child.status(), output.text(), errors.text()};
}

std::unique_ptr<ChildProcess> start_program(const fs::path& program,
                                            const std::vector<std::string>& arguments,
                                            const fs::path& log) {
  const int opened = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (opened < 0) throw_file_error(log, "open");
  const Descriptor file(opened);
  const Words words = words_of({program.c_str()}, arguments),
              environment = changed_environment({}, unsaid_threads());
  return std::make_unique<ChildProcess>([&] {
    setpgid(0, 0);
    become(words, environment, nothing_to_read(), file.number, file.number);
    dprintf(STDERR_FILENO, "ballast: %s: cannot be started: %s\n", words[0], std::strerror(errno));
    _exit(127);
  });
}

// ---- somebody else's program

namespace {

constexpr size_t longest_line = 4096, longest_complaint = 8192;  // bytes that are kept

/// The two ends of a connection in both directions: bytes written to one are read at the other.
/// They are sockets, because writing to one that nobody reads is an error here and not a signal.
struct Ends {
  Ends() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw_no_child();
    ours = ends[0];
    theirs = ends[1];
  }
  ~Ends() {
    if (ours >= 0) close(ours);
    close(theirs);
  }
  Ends(const Ends&) = delete;
  Ends& operator=(const Ends&) = delete;
  int ours, theirs;  // ours is -1 when it has another owner
};

/// Runs in the supervisor, which adopts every orphan of the program: kills its children until there
/// are none, and ends.
[[noreturn]] void end_descendants(int status) {
  do {
    // The kernel lists them, each followed by a blank; those that do not fit are in the next round.
    char list[4096];
    const int file = open("/proc/thread-self/children", O_RDONLY | O_CLOEXEC);
    const ssize_t size = read(file, list, sizeof list - 1);
    close(file);
    list[std::max<ssize_t>(size, 0)] = '\0';
    char* end = list;
    for (char* next = list; *next != '\0'; next = end + 1) {
      const long child = std::strtol(next, &end, 10);
      if (end == next || *end != ' ') break;
      kill(static_cast<pid_t>(child), SIGKILL);
    }
  } while (waitpid(-1, nullptr, 0) > 0);
  _exit(status);
}

/// Runs in the supervisor: lets `become_program` turn a child into the program, and ends with the
/// program's status or when it is asked to.
template <class Become>
[[noreturn]] void supervise(const Become& become_program) {
  // From here on SIGTERM clears up; the parent's death sends one. The supervisor adopts orphans,
  // and its own session puts it out of reach of the terminal's Ctrl-C.
  signal(SIGTERM, [](int) { end_descendants(128 + SIGKILL); });
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  setsid();
  const pid_t program = fork();
  if (program < 0) _exit(127);
  if (program == 0) {
    signal(SIGTERM, SIG_DFL);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    become_program();
    dprintf(STDERR_FILENO, "cannot be started: %s\n", std::strerror(errno));
    _exit(127);
  }
  // No end of the program's streams may stay open here: nobody would see that it closed them.
  close_range(0, ~0U, 0);
  int how = 0;
  while (waitpid(-1, &how, 0) != program) {
  }
  end_descendants(status_of(how));
}

/// Reads what is there, at most once; closes a descriptor whose other end has been closed.
void take(int& descriptor, std::string& text) {
  char block[1 << 16];
  const ssize_t got = read(descriptor, block, sizeof block);
  if (got > 0) {
    text.append(block, static_cast<size_t>(got));
  } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
    close(descriptor);
    descriptor = -1;
  }
}

}  // namespace

SupervisedProgram::SupervisedProgram(const std::string& command,
                                     const std::vector<std::string>& arguments,
                                     const SupervisedLimits& limits) {
  const std::string script = command + " \"$@\"";
  const Words words = words_of({"/bin/sh", "-c", script.c_str(), "sh"}, arguments);
  const Words environment = changed_environment({}, {});
  Ends talk, errors;
  const auto become_program = [&] {
    if (limits.memory_MB > 0.0) {
      const auto bytes = static_cast<rlim_t>(limits.memory_MB * 1048576.0);
      const rlimit limit{bytes, bytes};
      setrlimit(RLIMIT_AS, &limit);
    }
    dup2(errors.theirs, STDERR_FILENO);
    if (limits.folder.empty() || chdir(limits.folder.c_str()) == 0)
      become(words, environment, talk.theirs, talk.theirs, errors.theirs);
  };
  // There are two supervisors: where one is killed, the other clears up.
  supervisor_ =
      std::make_unique<ChildProcess>([&] { supervise([&] { supervise(become_program); }); });
  talk_ = std::exchange(talk.ours, -1);
  errors_ = std::exchange(errors.ours, -1);
}

SupervisedProgram::~SupervisedProgram() {
  // The supervisor clears up; if even it does not end, ChildProcess kills it. One that has just
  // been forked still has our handler, which may swallow the signal: it is asked again.
  for (int k = 0; k < 100; ++k) {
    supervisor_->send(SIGTERM);
    if (supervisor_->ends_within(0.1)) break;
  }
  for (const int end : {talk_, errors_})
    if (end >= 0) close(end);
}

bool SupervisedProgram::write_line(const std::string& line) const {
  const std::string text = line + '\n';
  return send(talk_, text.data(), text.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
         static_cast<ssize_t>(text.size());
}

void SupervisedProgram::close_input() const { shutdown(talk_, SHUT_WR); }

/// Waits until it writes something or closes its streams, and reads that; false when nothing came.
bool SupervisedProgram::listen(double seconds) {
  // It may go on after it has closed them: its end is then polled every millisecond.
  const double most = talk_ < 0 && errors_ < 0 ? 0.001 : 0.1;
  pollfd waiting[] = {{talk_, POLLIN, 0}, {errors_, POLLIN, 0}};
  const bool came =
      poll(waiting, 2, static_cast<int>(std::ceil(1e3 * std::min(seconds, most)))) > 0;
  if (waiting[0].revents != 0) take(talk_, heard_);
  if (waiting[1].revents != 0) take(errors_, complaints_);
  if (complaints_.size() > longest_complaint)
    complaints_.erase(0, complaints_.size() - longest_complaint);
  return came;
}

SupervisedProgram::Heard SupervisedProgram::read_line(std::string& line, double seconds) {
  const Stopwatch watch;
  for (;;) {
    if (const size_t end = heard_.find('\n'); end != std::string::npos) {
      line = heard_.substr(0, std::min(end, longest_line));
      heard_.erase(0, end + 1);
      return Heard::line;
    }
    // Of a line without end only the beginning is kept.
    if (heard_.size() > longest_line) heard_.resize(longest_line);
    if (talk_ < 0) return Heard::end;
    const double left = seconds - watch.seconds();
    if (!(left > 0.0) || InterruptGuard::requested()) return Heard::out_of_time;
    listen(left);
  }
}

bool SupervisedProgram::wait(double seconds) {
  for (const Stopwatch watch; !supervisor_->has_ended(); heard_.clear()) {
    const double left = seconds - watch.seconds();
    if (!(left > 0.0) || InterruptGuard::requested()) return false;
    listen(left);
  }
  while (listen(0.0)) {  // reads what it wrote before it ended
  }
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

std::string shell_quoted(const std::string& word) {
  if (is_plain(word, "_-./=+:,@%")) return word;
  // Within single quotes a shell takes every character as it is but the quote itself, which is
  // added outside of them.
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + '\'';
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_quoted(word);
  return line;
}

fs::path executable_path() { return fs::read_symlink("/proc/self/exe"); }

std::vector<std::string> process_arguments() {
  // Each word is followed by a zero.
  std::vector<std::string> words = split(read_whole_file("/proc/self/cmdline"), '\0');
  words.pop_back();
  return words;
}

void restart_with_one_algebra_thread() {
  const std::vector<std::string> words = process_arguments();
  const Words unsaid = unsaid_threads();
  if (unsaid.empty() || words.empty()) return;
  const Words environment = changed_environment({}, unsaid);
  const Words pointers = words_of({}, words);
  execve("/proc/self/exe", const_cast<char* const*>(pointers.data()),
         const_cast<char* const*>(environment.data()));
  throw Error("cannot start anew with OPENBLAS_NUM_THREADS=1");
}

}  // namespace ballast
