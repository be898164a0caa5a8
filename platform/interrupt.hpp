#pragma once
// Ctrl-C and kill: asked once per step, so that a run ends at a step with a checkpoint.

namespace ballast {

/// Catches SIGINT and SIGTERM while alive; a second signal of the same kind ends the program at
/// once.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool requested();
};

}  // namespace ballast
