#pragma once
// Work in a process of its own: what crashes, exits, leaks or cannot be interrupted there harms
// nobody here. For a copy of this program; other programs are started by program.hpp, with the
// means of this file.

#include <sys/types.h>

#include <functional>
#include <initializer_list>
#include <string>

namespace ballast {

enum class ChildEnd { complete, out_of_time, crashed };

struct ChildResult {
  ChildEnd end = ChildEnd::crashed;
  std::string answer;  ///< the bytes that `work` returned there; empty unless complete
};

/// Runs `work` in a forked child and waits for the bytes that it returns (platform/pack.hpp makes
/// and reads them), at most `max_seconds` of wall clock; then the child is killed. Only an answer
/// that arrived whole counts, whatever the exit code says (Debian's Ipopt can die with code 0). The
/// child prints nowhere and lets no exception out. Throws Error when no process can be made.
ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work);

/// This process was made by run_in_child(): what crashes, hangs or leaks here harms nobody, and
/// needs no further child.
bool is_expendable_process();

/// A forked child. It dies with this process (SIGKILL), however that comes about; the destructor
/// kills it if it still runs, and waits for it.
class ChildProcess {
 public:
  /// The child does `live` alone: no destructor or exit handler of this process runs there. When
  /// `live` returns or throws, it ends with exit code 1. Throws Error when no process can be made.
  /// Not to be called with threads about, unless `live` only executes another program.
  explicit ChildProcess(const std::function<void()>& live);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// It has ended; status() holds then.
  bool has_ended() { return collect(false); }
  /// Exit code; 128 + signal when a signal ended it.
  int status() const { return status_; }
  /// Nothing when it has ended.
  void send(int signal) const;

 private:
  bool collect(bool waits);

  pid_t child_ = -1;  // -1: waited for
  int status_ = 0;
};

/// A pipe that a child writes into; both ends are closed when this process executes another
/// program.
class Pipe {
 public:
  /// Throws Error.
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int write_end() const { return write_end_; }
  /// Here, once the child has been made: only then can the child's closing be seen.
  void close_write_end();

  /// Reads all `pipes` into their texts until their writers have closed them, at most `max_seconds`
  /// and most_bytes in all; false when it was given up.
  static bool read_until_closed(std::initializer_list<Pipe*> pipes, double max_seconds,
                                size_t most_bytes);
  std::string text;  ///< what has been read

 private:
  bool take();

  int read_end_ = -1, write_end_ = -1;
};

}  // namespace ballast
