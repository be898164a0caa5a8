#include "platform/program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"

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
  constexpr size_t most_bytes = 256u << 20;
  Pipe output, errors, failure;  // failure: why the program could not be started
  const Call call(program, arguments, plain_environment());
  const Stopwatch watch;
  // Where exec succeeds it closes the third pipe itself; where it fails that brings back why.
  ChildProcess child([&] {
    const int error = call.execute(output.write_end(), errors.write_end());
    _exit(write(failure.write_end(), &error, sizeof error) == sizeof error ? 127 : 1);
  });
  for (Pipe* pipe : {&output, &errors, &failure}) pipe->close_write_end();
  ProgramResult result;
  const bool is_closed = Pipe::read_until_closed({&output, &errors, &failure}, seconds, most_bytes);
  if (int error = 0; failure.text.size() == sizeof error) {
    std::memcpy(&error, failure.text.data(), sizeof error);
    result.was_found = false;
    result.status = 127;
    result.errors = std::strerror(error);
    return result;
  }
  // It may have closed its output and still go on: no waiting for ever.
  result.timed_out = !is_closed;
  while (!child.has_ended()) {
    if (watch.seconds() > seconds) result.timed_out = true;
    if (result.timed_out) child.send(SIGKILL);
    usleep(1000);
  }
  result.status = child.status();
  result.output = std::move(output.text);
  result.errors = std::move(errors.text);
  return result;
}

BackgroundProgram::BackgroundProgram(const fs::path& program,
                                     const std::vector<std::string>& arguments, const fs::path& log)
    : child_(start_beside(program, arguments, log)) {}

void BackgroundProgram::stop() const { child_.send(SIGTERM); }

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
