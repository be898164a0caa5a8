#pragma once
// Other processes: copies of this program for work that may crash, hang or leak, programs whose
// output is waited for, that run beside us, or that nobody trusts; and this program anew.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace ballast {

enum class ChildEnd { complete, out_of_time, crashed };

struct ChildResult {
  ChildEnd end = ChildEnd::crashed;
  std::string answer;  ///< the bytes that `work` returned there; empty unless complete
};

/// Runs `work` in a forked child and waits for the bytes that it returns (platform/pack.hpp makes
/// and reads them), at most `max_seconds` of wall clock; then the child is killed. Only an answer
/// that arrived whole counts, whatever the exit code says (Debian's Ipopt can die with code 0). The
/// child prints nowhere and lets no exception out. `is_cancelled`, if not empty, is asked here
/// twenty times a second: true ends the time. Throws Error when no process can be made.
ChildResult run_in_child(double max_seconds, const std::function<std::string()>& work,
                         const std::function<bool()>& is_cancelled = {});

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

struct ProgramResult {
  bool timed_out = false;  ///< and was killed
  int status = 0;          ///< exit code; 128 + signal; 127: it is not on PATH
  std::string output;      ///< standard output
  std::string errors;      ///< standard error, or why it cannot be started
  bool succeeded() const { return !timed_out && status == 0; }
};

/// Runs program (looked up on PATH) with arguments, standard input empty, in the C locale and
/// without the variables GNUPLOT* and GNUTERM; kills it after `seconds`. It cannot write more than
/// 256 MB. Throws Error when there can be no child at all.
ProgramResult run_program(const std::string& program, const std::vector<std::string>& arguments,
                          double seconds);

/// Starts a program (a path) that runs beside this one; what it writes is appended to `log`. It is
/// in a process group of its own: Ctrl-C does not reach it, and SIGTERM asks it to end (runs write
/// a checkpoint first). Linear algebra in one thread (OPENBLAS_NUM_THREADS=1 ...) unless the
/// environment says otherwise. Its status is 127 when it could not be started. Throws Error when
/// there can be no child.
std::unique_ptr<ChildProcess> start_program(const std::filesystem::path& program,
                                            const std::vector<std::string>& arguments,
                                            const std::filesystem::path& log);

// Somebody else's program, of which nothing is believed: whatever it does, waiting for it ends in
// time, what it writes takes no memory here, and no process of its making is left.

struct SupervisedLimits {
  double memory_MB = 0.0;             ///< address space of each of its processes; 0: no limit
  std::filesystem::path folder = {};  ///< where it starts; empty: here
};

/// It runs under a supervisor, a process of ours that kills all its descendants, those that moved
/// to sessions of their own included, when it ends, when this object goes, or when this process
/// dies, however that comes about. The supervisor has one itself, in case it is killed.
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
  void close_input() const;

  enum class Heard { line, end, out_of_time };
  /// The next line of its standard output, without the line's end and cut at 4 kB; its end when it
  /// has closed both that and its input. The time is over as well when somebody asks this process
  /// to stop (InterruptGuard).
  Heard read_line(std::string& line, double seconds);
  /// Until it has ended, whatever it writes meanwhile; false: it still runs.
  bool wait(double seconds);

  /// After its end: exit code, 128 + signal when a signal ended it, 127 when it was not found.
  int status() const { return supervisor_->status(); }
  /// The last line of its standard error that says anything; empty without.
  std::string last_words() const;

 private:
  bool listen(double seconds);

  int talk_ = -1, errors_ = -1;  // its standard input and output; its standard error
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
