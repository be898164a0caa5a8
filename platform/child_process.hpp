#pragma once
// Work in a process of its own: what crashes, exits, leaks or cannot be interrupted there harms
// nobody here. For a copy of this program; other programs are started by program.hpp, with the
// means of this file.

#include <sys/types.h>

#include <functional>
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
  /// Waits at most so long; whether it has ended.
  bool ends_within(double seconds);
  /// Exit code; 128 + signal when a signal ended it.
  int status() const { return status_; }
  /// Nothing when it has ended.
  void send(int signal) const;

 private:
  bool collect(bool waits);

  pid_t child_ = -1;  // -1: waited for
  int status_ = 0;
};

/// A file in memory that a child writes into and that is read here when the child has ended; not
/// left open in other programs.
class MemoryFile {
 public:
  /// Throws Error.
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int descriptor() const { return descriptor_; }
  /// All that has been written.
  std::string text() const;

 private:
  int descriptor_;
};

}  // namespace ballast
