#pragma once
// Other programs as children: one whose output is waited for, one that runs beside us and writes
// into a log, one that nobody trusts, and this program anew.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "platform/child_process.hpp"

namespace ballast {

struct ProgramResult {
  bool was_found = true;   ///< the program is on PATH
  bool timed_out = false;  ///< and was killed
  int status = 0;          ///< exit code; 128 + signal when a signal ended it
  std::string output;      ///< standard output
  std::string errors;      ///< standard error
  bool succeeded() const { return was_found && !timed_out && status == 0; }
};

/// Runs program (looked up on PATH) with arguments, standard input empty, in the C locale and
/// without the variables GNUPLOT* and GNUTERM; kills it after `seconds`. It cannot write more than
/// 256 MB. Throws Error when there can be no child at all.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          double seconds);

/// A program that runs beside this one and writes into a log. It is in a process group of its own,
/// so that Ctrl-C reaches it only by stop(); it dies with this process.
class BackgroundProgram {
 public:
  /// `program`: a path. What it writes is appended to `log`. Linear algebra in one thread
  /// (OPENBLAS_NUM_THREADS=1 ...) unless the environment says otherwise. Throws Error when there
  /// can be no child.
  BackgroundProgram(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                    const std::filesystem::path& log);

  /// It has ended; status() holds then.
  bool has_ended() { return child_.has_ended(); }
  /// Exit code; 128 + signal when a signal ended it; 127 when it could not be started.
  int status() const { return child_.status(); }
  /// Asks it to end (SIGTERM): runs write a checkpoint first.
  void stop() const;

 private:
  ChildProcess child_;
};

// Somebody else's program, of which nothing is believed: whatever it does, waiting for it ends in
// time, what it writes takes no memory here, and no process of its making is left.

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

/// The last line of a log that says anything; without "ballast: ".
std::string last_line(const std::filesystem::path& log);

/// A word as a shell reads it back: in quotes where it has to be.
std::string shell_word(const std::string& word);
/// Words as a line for a shell.
std::string shell_line(const std::vector<std::string>& words);

/// This program's file.
std::filesystem::path own_program();
/// The command line of this process, as it was given.
std::vector<std::string> own_words();
/// This program begins again with linear algebra in one thread, unless the environment says how
/// many: a threaded BLAS reads that when it is loaded. Throws Error.
void restart_with_one_algebra_thread();

}  // namespace ballast
