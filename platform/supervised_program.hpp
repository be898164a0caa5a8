#pragma once
// Somebody else's program, of which nothing is believed: whatever it does, waiting for it ends in
// time, what it writes takes no memory here, and no process of its making is left.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "platform/child_process.hpp"

namespace ballast {

struct SupervisedLimits {
  double memory_MB = 0.0;             ///< address space of each of its processes; 0: no limit
  std::filesystem::path folder = {};  ///< where it starts; empty: here
};

/// It runs under a supervisor, a process of ours that kills all its descendants, those that moved
/// to sessions of their own included, when it ends, when this object goes, or when this process
/// dies, however that comes about.
class SupervisedProgram {
 public:
  /// `command` is read by /bin/sh, which appends `arguments` to it: "python3 'my solver.py'". Its
  /// standard input is what write_line() says. Throws Error when there can be no process.
  SupervisedProgram(const std::string& command, const std::vector<std::string>& arguments,
                    const SupervisedLimits& limits);
  ~SupervisedProgram();
  SupervisedProgram(const SupervisedProgram&) = delete;
  SupervisedProgram& operator=(const SupervisedProgram&) = delete;

  /// One line for its standard input; false when it does not take it.
  bool write_line(const std::string& line) const;
  /// Its standard input ends.
  void close_input();

  enum class Heard { line, end, out_of_time };
  /// The next line of its standard output, without the line's end and cut at 4 kB. The time is
  /// over as well when somebody asks this process to stop (InterruptGuard).
  Heard read_line(std::string& line, double seconds);
  /// Until it has ended, whatever it writes meanwhile; false: it still runs.
  bool wait(double seconds);

  /// After its end: exit code, 128 + signal when a signal ended it, 127 when it was not found.
  int status() const { return supervisor_->status(); }
  /// The last line of its standard error that says anything; empty without.
  std::string last_words() const;

 private:
  bool listen(double seconds);

  int input_ = -1, output_ = -1, errors_ = -1;
  std::string heard_, complaints_;
  std::unique_ptr<ChildProcess> supervisor_;
};

}  // namespace ballast
