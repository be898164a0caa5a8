#pragma once
// Made-up runs for a recorder, and killed ones.

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/sample_run.hpp"

namespace ballast {

constexpr double sample_step = 2e-4;  // [s]

/// Memory of `step % 4` contacts, with numbers that depend on the step and the contact.
inline StepMemory sample_memory(long step) {
  StepMemory memory;
  for (int c = 0; c < step % 4; ++c) {
    const double x = static_cast<double>(step) + 0.1 * c;
    memory.contacts.push_back({c, c + 1, 7, Vec3(0, 0, 1), Vec3(x, -x, 2 * x), -1e-6 * x});
    memory.impulses.push_back(Vec3(0.0, 0.5, x) * sample_step);
  }
  return memory;
}

/// Records the steps first .. last, with a frame at every fifth (and at 0), as a run does.
inline void record(Recorder& recorder, const MechanicalSystem& system, long first, long last) {
  for (long step = first == 1 ? 0 : first; step <= last; ++step) {
    if (step > 0) recorder.add_step(sample_row(step));
    if (step % 5 != 0) continue;
    const MotionState state = sample_state(system, step);
    recorder.add_frame(state, sample_memory(step), sample_step);
  }
}

/// A folder with the record of the sample system's first steps, still open but flushed to disk.
struct OpenRecord {
  explicit OpenRecord(long steps, bool with_forces = false)
      : recorder(folder.path(), system, 0, with_forces) {
    record(recorder, system, 1, steps);
    recorder.flush();
  }
  const std::filesystem::path& path() const { return folder.path(); }

  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder;
};

inline void check_record(const std::filesystem::path& folder, const MechanicalSystem& system,
                         long steps) {
  const auto rows = read_steps(folder);
  REQUIRE(rows.size() == static_cast<size_t>(steps));
  for (long k = 0; k < steps; ++k) CHECK(same_bits(rows[k], sample_row(k + 1)));
  const auto frames = read_poses(folder);
  REQUIRE(frames.size() == static_cast<size_t>(steps / 5 + 1));
  for (size_t k = 0; k < frames.size(); ++k)
    CHECK(same_bits(frames[k], sample_state(system, 5 * static_cast<long>(k))));
}

/// Runs `action` in a child that then dies without cleaning up, as by kill -9: its buffers are
/// lost.
template <class Action>
void killed(Action&& action) {
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    action();
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE((WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL));
}

}  // namespace ballast
