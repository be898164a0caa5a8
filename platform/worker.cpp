#include "platform/worker.hpp"

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

/// Becomes the program, or ends.
[[noreturn]] void be_worker(pid_t parent, int log, const std::vector<char*>& words) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // the parent died before the line above
  setpgid(0, 0);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  setenv("OMP_NUM_THREADS", "1", 0);
  execv(words[0], words.data());
  dprintf(STDERR_FILENO, "ballast: %s: cannot be started: %s\n", words[0], std::strerror(errno));
  _exit(127);
}

}  // namespace

Worker::Worker(const fs::path& program, const std::vector<std::string>& arguments,
               const fs::path& log) {
  const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file < 0) throw_file_error(log, "open");
  std::vector<std::string> texts{program.string()};
  texts.insert(texts.end(), arguments.begin(), arguments.end());
  std::vector<char*> words;
  for (std::string& text : texts) words.push_back(text.data());
  words.push_back(nullptr);
  const pid_t parent = getpid();
  child_ = fork();
  if (child_ == 0) be_worker(parent, file, words);
  const int error = errno;
  close(file);
  if (child_ < 0) throw Error(std::string("cannot start a child process: ") + std::strerror(error));
}

Worker::~Worker() {
  if (child_ < 0) return;
  kill(child_, SIGKILL);
  while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

bool Worker::has_ended() {
  if (child_ < 0) return true;
  int status = 0;
  if (waitpid(child_, &status, WNOHANG) != child_) return false;
  child_ = -1;
  status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return true;
}

void Worker::stop() const {
  if (child_ > 0) kill(child_, SIGTERM);
}

std::string last_line(const fs::path& log) {
  std::ifstream stream(log);
  std::string last;
  for (std::string line; std::getline(stream, line);)
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  constexpr std::string_view prefix = "ballast: ";
  return last.starts_with(prefix) ? last.substr(prefix.size()) : last;
}

fs::path own_program() { return fs::read_symlink("/proc/self/exe"); }

}  // namespace ballast
