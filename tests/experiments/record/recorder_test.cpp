// Records of runs that ended normally, and logs of killed runs: the rows that are kept and cut off,
// and the logs that are refused.

#include "experiments/record/recorder.hpp"

#include <cstdlib>

#include "tests/experiments/record/sample_record.hpp"
#include "tests/support/file_size_limit.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("records come back to the last bit, from the logs and from record.h5") {
  for (const long steps : {23, 0, 6000}) {  // the last: more frames than one buffer holds
    OpenRecord open(steps);
    check_record(open.path(), open.system, steps);
    open.recorder.finish("scene text", "{}");
    fs::remove_all(open.path() / "log");
    check_record(open.path(), open.system, steps);
    CHECK_FALSE(fs::exists(open.path() / "record.h5.tmp"));
  }
}

TEST_CASE("steps.csv has a line of names and then numbers that round trip") {
  OpenRecord open(4);
  open.recorder.finish("", "");
  std::istringstream lines(file_bytes(open.path() / "steps.csv"));
  std::string line, names;
  for (const StepColumn& column : step_columns())
    names.append(names.empty() ? "" : ",").append(column.name);
  REQUIRE(std::getline(lines, line));
  CHECK(line == names);
  for (long step = 1; step <= 4; ++step) {
    REQUIRE(std::getline(lines, line));
    std::istringstream cells(line);
    std::string cell;
    for (const StepColumn& column : step_columns()) {
      REQUIRE(std::getline(cells, cell, ','));
      CHECK(same_bits(std::strtod(cell.c_str(), nullptr), sample_row(step).*column.value));
    }
    CHECK_FALSE(std::getline(cells, cell));
  }
  CHECK_FALSE(std::getline(lines, line));
}

TEST_CASE("a killed and resumed run leaves the same files as one that went through") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  killed([&] {
    Recorder recorder(folder.path(), system, 0, true);
    record(recorder, system, 1, 12);
    recorder.flush();                     // as with the checkpoint of step 12
    record(recorder, system, 113, 1000);  // other steps, more than a buffer holds
  });
  CHECK(read_steps(folder.path()).size() > 12);
  for (int life = 0; life < 2; ++life) {  // dies twice at the same place
    killed([&] {
      Recorder recorder(folder.path(), system, 12, true);
      record(recorder, system, 13, 14);
    });
  }
  Recorder resumed(folder.path(), system, 12, true);
  record(resumed, system, 13, 23);
  resumed.finish("scene", "manifest");
  OpenRecord through(23, true);
  through.recorder.finish("scene", "manifest");
  check_record(folder.path(), system, 23);
  for (const char* name :
       {"log/steps.bin", "log/poses.bin", "log/forces.bin", "steps.csv", "record.h5"})
    CHECK((file_bytes(folder.path() / name) == file_bytes(through.path() / name)));
}

TEST_CASE("damage after what was flushed ends a log, and is cut off") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  killed([&] {
    Recorder recorder(folder.path(), system, 0);
    record(recorder, system, 1, 10);
    recorder.flush();
    record(recorder, system, 11, 400);
  });
  const fs::path log = folder.path() / "log" / "steps.bin";
  std::string damaged = file_bytes(log);
  damaged[damaged.size() - 5 * 8 * (step_columns().size() + 1)] ^= 1;
  put_bytes(log, damaged);
  const auto rows = read_steps(folder.path());
  CHECK((rows.size() >= 10 && rows.size() < 400));
  Recorder recorder(folder.path(), system, 10);
  CHECK(read_steps(folder.path()).size() == 10);
}

TEST_CASE("logs that do not fit the checkpoint or the system are refused") {
  const OpenRecord open(10);
  const auto refusal = [&](const MechanicalSystem& other, long last_step) {
    return run_error([&] { Recorder(open.path(), other, last_step); });
  };
  const MechanicalSystem& system = open.system;
  const std::string steps = (open.path() / "log" / "steps.bin").string(),
                    poses = (open.path() / "log" / "poses.bin").string();
  CHECK_THAT(refusal(system, 11),
             Contains(steps) && Contains("has 10 steps, the checkpoint is at step 11"));
  require_same_bodies(open.path(), system);
  require_same_bodies(open.path() / "no log", system);  // there is nothing to compare with
  MechanicalSystem other = sample_system();
  other.bodies[1].mass *= 1.0 + 1e-15;
  CHECK_THAT(refusal(other, 10), Contains(steps) && Contains("another system of bodies"));
  CHECK_THAT(run_error([&] { require_same_bodies(open.path(), other); }),
             Contains("another system of bodies"));

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

TEST_CASE("starting afresh and going on both remove records of before") {
  for (const size_t kept : {0, 7}) {
    OpenRecord open(10);
    open.recorder.finish("", "");
    Recorder recorder(open.path(), open.system, static_cast<long>(kept));
    CHECK(read_steps(open.path()).size() == kept);
    CHECK(read_poses(open.path()).size() == (kept > 0 ? 2u : 0u));
    for (const char* name : {"record.h5", "steps.csv"}) CHECK_FALSE(fs::exists(open.path() / name));
  }
}

TEST_CASE("a full disk is an error that names the file, and spoils nothing") {
  OpenRecord open(10);
  Recorder& recorder = open.recorder;
  const std::string name = GENERATE(as<std::string>{}, "steps.bin", "steps.csv", "record.h5");
  if (name == "steps.bin") {
    const FileSizeLimit limit(8192);
    CHECK_THAT(run_error([&] {
                 for (long step = 11; step < 2000; ++step) recorder.add_step(sample_row(step));
                 recorder.flush();
               }),
               Contains(name) && Contains("File too large"));
  } else {
    fs::create_symlink("/dev/full", open.path() / (name + ".tmp"));
    CHECK_THAT(run_error([&] { recorder.finish("", ""); }),
               Contains(name) && Contains("No space left"));
    CHECK_FALSE(fs::exists(open.path() / name));
  }
  CHECK_FALSE(fs::exists(open.path() / "record.h5.tmp"));
  Recorder resumed(open.path(), open.system, 10);
  record(resumed, open.system, 11, 12);
  resumed.finish("", "");
  check_record(open.path(), open.system, 12);
}
