#pragma once
// One child process of a sweep.

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ballast {

/// A program that runs beside this one and writes into a log. It is in a process group of its own,
/// so that Ctrl-C reaches it only by stop(); it dies at once (SIGKILL) when this process dies,
/// however that comes about.
class Worker {
 public:
  /// `program`: a path. What it writes is appended to `log`. Single-threaded linear algebra
  /// (OPENBLAS_NUM_THREADS=1 ...) unless the environment says otherwise. Throws Error when there
  /// can be no child. Not to be called with threads about.
  Worker(const std::filesystem::path& program, const std::vector<std::string>& arguments,
         const std::filesystem::path& log);
  /// Kills it if it still runs.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// It has ended; status() holds then.
  bool has_ended();
  /// Exit code; 128 + signal when a signal ended it.
  int status() const { return status_; }
  /// Asks it to end (SIGTERM): runs write a checkpoint first.
  void stop() const;

 private:
  pid_t child_ = -1;  // -1: waited for
  int status_ = 0;
};

/// The last line of a log that says anything; without "ballast: ".
std::string last_line(const std::filesystem::path& log);

/// This program's file.
std::filesystem::path own_program();

}  // namespace ballast
