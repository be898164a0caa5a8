#pragma once
// Ctrl-C, kill, a closed terminal, a batch system's warning: asked once per step, so that a run
// ends at a step with a checkpoint.

namespace ballast {

/// Catches SIGINT, SIGTERM, SIGHUP (unless it is ignored, as under nohup) and SIGUSR1 (Slurm's
/// warning before a time limit) while alive; a second SIGINT or SIGTERM ends the program at once.
/// SIGPIPE is ignored meanwhile: who stops reading what a run prints does not end the run.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool requested();
};

}  // namespace ballast
