#pragma once
// Handling of signals and closed streams. Ctrl-C, kill, a closed terminal and a batch system's
// warning are polled once per step, so that a run ends at a step with a checkpoint.

namespace ballast {

/// Catches SIGINT, SIGTERM, SIGHUP (unless it is ignored, as under nohup) and SIGUSR1 (Slurm's
/// warning before a time limit) while alive; a second SIGINT or SIGTERM ends the program at once.
/// SIGPIPE is ignored meanwhile: a reader that stops reading the output does not end the run. A
/// guard within another's life changes nothing: a request holds until the outer guard ends. All
/// guards are made by one thread.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool requested();
};

/// Prepares the process; every program of ours calls this first, before it opens a file:
///
/// - Standard input, output and error that were closed (`>&-`, a daemon) are opened on /dev/null.
///   The next file that is opened would otherwise get their number, and all that is printed would
///   land in it: in a log or in a record.
/// - A file that grows beyond the limit of `ulimit -f` is an error that names it (errno EFBIG), not
///   a death by SIGXFSZ without a word.
void prepare_standard_streams();

}  // namespace ballast
