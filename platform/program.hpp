#pragma once
// Other processes: copies of this program for work that may crash, hang or leak; programs whose
// output is waited for, that run beside us, or that are not trusted; and a restart of this program.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ballast {

enum class ChildEnd { complete, failed, out_of_time, crashed };

struct ChildResult {
  ChildEnd end = ChildEnd::crashed;
  /// Complete: the bytes that `work` returned there. Failed: what() of the exception that it threw.
  std::string answer;
};

/// Runs `work` in a forked child and waits for the bytes that it returns (platform/pack.hpp makes
/// and reads them), at most `max_seconds` of wall clock; then the child is killed. Only an answer
/// that arrived whole counts, whatever the exit code says (Debian's Ipopt can die with code 0). The
/// child prints nothing. `is_cancelled`, if not empty, is called here twenty times a second; true
/// ends the time. Throws Error when no process can be made.
ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work,
                         const std::function<bool()>& is_cancelled = {});

/// True where this process was made by run_in_child(): a crash, hang or leak here does no harm, and
/// needs no further child.
bool is_expendable_process();

/// A forked child. It is killed (SIGKILL) when this process ends in any way; the destructor kills
/// it if it still runs, and waits for it.
class ChildProcess {
 public:
  /// The child runs only `live`: no destructor or exit handler of this process runs there. When
  /// `live` returns or throws, the child ends with exit code 1. Throws Error when no process can be
  /// made. Must not be called while there are threads, unless `live` only executes another program.
  explicit ChildProcess(const std::function<void()>& live);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// True where it has ended; then status() is valid.
  bool has_ended() { return collect(false); }
  /// Waits for at most `seconds`; returns whether it has ended.
  bool ends_within(double seconds);
  /// Exit code; 128 + signal when a signal ended it.
  int status() const { return status_; }
  /// Sends a signal; does nothing when it has ended.
  void send(int signal) const;

 private:
  bool collect(bool waits);

  pid_t child_ = -1;  // -1: it was waited for
  int status_ = 0;
};

struct ProgramResult {
  bool timed_out = false;  ///< and was killed
  int status = 0;          ///< exit code; 128 + signal; 127: it is not on PATH
  std::string output;      ///< standard output
  std::string errors;      ///< standard error, or why it cannot be started
  bool succeeded() const { return !timed_out && status == 0; }
};

/// Runs program (looked up on PATH) with arguments, standard input empty, in the C locale and
/// without the variables GNUPLOT* and GNUTERM; kills it after `seconds`. It cannot write more than
/// 256 MB. Throws Error when no child process can be made.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          double seconds);

/// Starts a program (a path) that runs beside this one; its output is appended to `log`. It is in a
/// process group of its own: Ctrl-C does not reach it, and SIGTERM asks it to end (runs write a
/// checkpoint first). Its linear algebra uses one thread (OPENBLAS_NUM_THREADS=1 ...) unless the
/// environment says otherwise. Its status is 127 when it could not be started. Throws Error when no
/// child process can be made.
std::unique_ptr<ChildProcess> start_program(const std::filesystem::path& program,
                                            const std::vector<std::string>& arguments,
                                            const std::filesystem::path& log);

// A program of somebody else, which is not trusted: whatever it does, waiting for it ends in time,
// its output takes only bounded memory here, and none of its processes is left.

struct SupervisedLimits {
  double memory_MB = 0.0;             ///< address space of each of its processes; 0: no limit
  std::filesystem::path folder = {};  ///< where it starts; empty: here
};

/// The program runs under a supervisor, a process of ours that kills all the program's descendants,
/// also those in sessions of their own, when the program ends, this object is destroyed, or this
/// process dies in any way. The supervisor has one itself, in case it is killed.
class SupervisedProgram {
 public:
  /// `command` is read by /bin/sh, which appends `arguments` to it: "python3 'my solver.py'". Its
  /// standard input is the lines of write_line(). Throws Error when no process can be made.
  SupervisedProgram(const std::string& command, const std::vector<std::string>& arguments,
                    const SupervisedLimits& limits);
  ~SupervisedProgram();
  SupervisedProgram(const SupervisedProgram&) = delete;
  SupervisedProgram& operator=(const SupervisedProgram&) = delete;

  /// Writes one line to its standard input; false when it does not take it.
  bool write_line(const std::string& line) const;
  /// Ends its standard input.
  void close_input() const;

  enum class Heard { line, end, out_of_time };
  /// Reads the next line of its standard output, without the line's end and cut at 4 kB. `end`: it
  /// has closed both its output and its input. `out_of_time`: the time is over, or this process was
  /// asked to stop (InterruptGuard).
  Heard read_line(std::string& line, double seconds);
  /// Waits until it has ended, whatever it writes meanwhile; false: it still runs.
  bool wait(double seconds);

  /// After its end: exit code, 128 + signal when a signal ended it, 127 when it was not found.
  int status() const { return supervisor_->status(); }
  /// The last line of its standard error that is not blank; empty where there is none.
  std::string last_words() const;

 private:
  bool listen(double seconds);

  int talk_ = -1, errors_ = -1;  // its standard input and output; its standard error
  std::string heard_, complaints_;
  std::unique_ptr<ChildProcess> supervisor_;
};

/// The last line of a log that is not blank, without a leading "ballast: ".
std::string last_line(const std::filesystem::path& log);

/// A word as a shell reads it back: in quotes where it has to be.
std::string shell_quoted(const std::string& word);
/// Words as a line for a shell.
std::string shell_line(const std::vector<std::string>& words);

/// The path of this program's executable.
std::filesystem::path executable_path();
/// The command line of this process, as it was given.
std::vector<std::string> process_arguments();
/// Restarts this program with linear algebra in one thread, unless the environment sets the number
/// of threads: a threaded BLAS reads it when it is loaded. Throws Error.
void restart_with_one_algebra_thread();

}  // namespace ballast
