// Logs of runs that died: what is kept, what is cut off, what is refused.

#include "experiments/record/recorder.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a killed and resumed run leaves the same files as one that went through") {
  const TemporaryFolder folder, through;
  const MechanicalSystem system = sample_system();
  killed([&] {
    Recorder recorder(folder.path(), system, 0);
    record(recorder, system, 1, 12);
    recorder.flush();                            // with the checkpoint of step 12
    for (long step = 13; step <= 400; ++step) {  // more than a buffer holds
      recorder.add_step(sample_row(step + 7));
      recorder.add_poses(sample_state(system, step));
    }
  });
  CHECK(read_steps(folder.path()).size() >= 12);
  CHECK(fs::file_size(steps_log(folder.path())) >
        13 * 28 * 8);                     // something was written after the checkpoint
  for (int life = 0; life < 2; ++life) {  // dies twice at the same place
    killed([&] {
      Recorder recorder(folder.path(), system, 12);
      record(recorder, system, 13, 14);
    });
  }
  Recorder resumed(folder.path(), system, 12);
  record(resumed, system, 13, 23);
  resumed.finish("scene", "manifest");
  Recorder whole(through.path(), system, 0);
  record(whole, system, 1, 23);
  whole.finish("scene", "manifest");
  check_record(folder.path(), system, 23);
  for (const char* name : {"log/steps.bin", "log/poses.bin", "steps.csv", "record.h5"})
    CHECK(file_bytes(folder.path() / name) == file_bytes(through.path() / name));
}

TEST_CASE("a log torn in the middle of a row is read up to there") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  killed([&] {
    Recorder recorder(folder.path(), system, 0);
    record(recorder, system, 1, 10);
    recorder.flush();
    record(recorder, system, 11, 400);
  });
  const size_t flushed = 10;
  const std::string torn = file_bytes(steps_log(folder.path()));
  const size_t row = (step_columns().size() + 1) * 8;
  size_t previous = 0;
  for (size_t cut = 0; cut < 3 * row; ++cut) {
    put_bytes(steps_log(folder.path()), std::string_view(torn).substr(0, torn.size() - cut));
    const auto rows = read_steps(folder.path());
    CHECK((rows.size() >= flushed &&
           (cut == 0 || rows.size() == previous || rows.size() + 1 == previous)));
    previous = rows.size();
  }
  SECTION("and damage after what was flushed ends it") {
    std::string damaged = torn;
    damaged[damaged.size() - 5 * row] ^= 1;
    put_bytes(steps_log(folder.path()), damaged);
    const auto rows = read_steps(folder.path());
    CHECK((rows.size() >= flushed && rows.size() < 400));
    Recorder recorder(folder.path(), system, 10);
    CHECK(read_steps(folder.path()).size() == 10);
  }
}

TEST_CASE("logs that do not fit the checkpoint or the system are refused") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  leave_logs(folder.path(), system, 10);
  const auto refusal = [&](const MechanicalSystem& other, long last_step) {
    return run_error([&] { Recorder(folder.path(), other, last_step); });
  };
  const std::string steps = steps_log(folder.path()).string(),
                    poses = poses_log(folder.path()).string();
  CHECK_THAT(refusal(system, 11),
             Contains(steps) && Contains("has 10 steps, the checkpoint is at step 11"));
  MechanicalSystem other = sample_system();
  other.bodies[1].mass *= 1.0 + 1e-15;
  CHECK_THAT(refusal(other, 10), Contains(steps) && Contains("another system"));

  const std::string whole = file_bytes(poses), whole_steps = file_bytes(steps);
  put_bytes(poses, std::string_view(whole).substr(0, whole.size() - 1));
  CHECK_THAT(refusal(system, 10), Contains(poses) && Contains("is truncated: 2 rows of 3"));
  put_bytes(poses, whole);
  put_bytes(steps, std::string_view(whole_steps).substr(0, 30));
  CHECK_THAT(refusal(system, 10), Contains(steps) && Contains("truncated in its header"));
  put_bytes(steps, "solid ballast, and some more text than a header has");
  CHECK_THAT(refusal(system, 10), Contains(steps) && Contains("is not a log"));
  fs::remove(steps);
  CHECK_THAT(refusal(system, 10), Contains(steps) && Contains("cannot open"));
}

TEST_CASE("any flipped bit of a flushed log is found") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  leave_logs(folder.path(), system, 5);
  for (const fs::path& log : {steps_log(folder.path()), poses_log(folder.path())}) {
    std::string bytes = file_bytes(log);
    for (size_t at = 0; at < bytes.size(); ++at) {
      const char bit = static_cast<char>(1 << at % 8);
      bytes[at] ^= bit;
      put_bytes(log, bytes);
      const std::string message = run_error([&] {
        read_steps(folder.path());
        read_poses(folder.path());
      });
      if (message.rfind(log.string(), 0) != 0) FAIL_CHECK("byte " << at << ": " << message);
      bytes[at] ^= bit;
    }
    put_bytes(log, bytes);
  }
}

TEST_CASE("starting afresh and going on both remove records of before") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  {
    Recorder recorder(folder.path(), system, 0);
    record(recorder, system, 1, 10);
    recorder.finish("", "");
  }
  SECTION("afresh") {
    Recorder recorder(folder.path(), system, 0);
    CHECK(read_steps(folder.path()).empty());
    CHECK(read_poses(folder.path()).empty());
  }
  SECTION("going on") {
    Recorder recorder(folder.path(), system, 7);
    CHECK(read_steps(folder.path()).size() == 7);
    CHECK(read_poses(folder.path()).size() == 2);
  }
  CHECK_FALSE(fs::exists(folder.path() / "record.h5"));
  CHECK_FALSE(fs::exists(folder.path() / "steps.csv"));
}
