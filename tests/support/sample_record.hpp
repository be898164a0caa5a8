#pragma once
// Made-up runs told to a recorder, and killed ones.

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/sample_run.hpp"

namespace ballast {

/// Steps first .. last, a frame at every fifth (and at 0), as a run does.
inline void record(Recorder& recorder, const MechanicalSystem& system, long first, long last) {
  if (first == 1) recorder.add_poses(sample_state(system, 0));
  for (long step = first; step <= last; ++step) {
    recorder.add_step(sample_row(step));
    if (step % 5 == 0) recorder.add_poses(sample_state(system, step));
  }
}

/// A folder with the record of the sample system's first steps, still open.
struct OpenRecord {
  explicit OpenRecord(long steps) { record(recorder, system, 1, steps); }
  const std::filesystem::path& path() const { return folder.path(); }

  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder{folder.path(), system, 0};
};

/// The logs of a run of the sample system that died after its checkpoint at step `last`.
inline void leave_logs(const std::filesystem::path& folder, const MechanicalSystem& system,
                       long last) {
  Recorder recorder(folder, system, 0);
  record(recorder, system, 1, last);
  recorder.flush();
}

inline void check_record(const std::filesystem::path& folder, const MechanicalSystem& system,
                         long steps) {
  const auto rows = read_steps(folder);
  REQUIRE(rows.size() == static_cast<size_t>(steps));
  for (long k = 0; k < steps; ++k) CHECK(same_bits(rows[k], sample_row(k + 1)));
  const auto frames = read_poses(folder);
  REQUIRE(frames.size() == static_cast<size_t>(steps / 5 + 1));
  for (size_t k = 0; k < frames.size(); ++k) {
    const MotionState state = sample_state(system, 5 * static_cast<long>(k));
    CHECK(frames[k].step == state.step);
    CHECK(same_bits(frames[k].time, state.time));
    CHECK(same_bits(frames[k].pose, state.pose));
    CHECK(same_bits(frames[k].velocity, state.velocity));
    CHECK(same_bits(frames[k].spin, state.spin));
  }
}

inline std::filesystem::path steps_log(const std::filesystem::path& folder) {
  return folder / "log" / "steps.bin";
}
inline std::filesystem::path poses_log(const std::filesystem::path& folder) {
  return folder / "log" / "poses.bin";
}

/// Runs `action` in a child that then dies without cleaning up, as by kill -9: what it had buffered
/// is lost.
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
