#include "experiments/record/recorder.hpp"

#include <cstdlib>

#include "platform/hdf5_file.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/sample_record.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("records come back to the last bit, from the logs and from record.h5") {
  OpenRecord open(23);
  open.recorder.flush();
  check_record(open.path(), open.system, 23);
  open.recorder.finish("scene text", "{}");
  fs::remove_all(open.path() / "log");
  check_record(open.path(), open.system, 23);
  CHECK_FALSE(fs::exists(open.path() / "record.h5.tmp"));
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

TEST_CASE("a run without a step has an empty record") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder(folder.path(), system, 0).finish("", "");
  CHECK(read_steps(folder.path()).empty());
  CHECK(read_poses(folder.path()).empty());
}

TEST_CASE("a full disk is an error that names the file, and spoils nothing") {
  const TemporaryFolder folder;
  const MechanicalSystem system = sample_system();
  Recorder recorder(folder.path(), system, 0);
  record(recorder, system, 1, 10);
  recorder.flush();
  SECTION("the logs") {
    const FileSizeLimit limit(8192);
    CHECK_THAT(run_error([&] {
                 for (long step = 11; step < 2000; ++step) recorder.add_step(sample_row(step));
                 recorder.flush();
               }),
               Contains("steps.bin") && Contains("File too large"));
  }
  SECTION("steps.csv") {
    fs::create_symlink("/dev/full", folder.path() / "steps.csv.tmp");
    CHECK_THAT(run_error([&] { recorder.finish("", ""); }),
               Contains("steps.csv") && Contains("No space left"));
    CHECK_FALSE(fs::exists(folder.path() / "steps.csv"));
  }
  SECTION("record.h5") {
    fs::create_symlink("/dev/full", folder.path() / "record.h5.tmp");
    CHECK_THAT(run_error([&] { recorder.finish("", ""); }),
               Contains("record.h5") && Contains("No space left"));
    CHECK_FALSE(fs::exists(folder.path() / "record.h5"));
  }
  CHECK_FALSE(fs::exists(folder.path() / "record.h5.tmp"));
  Recorder resumed(folder.path(), system, 10);
  record(resumed, system, 11, 12);
  resumed.finish("", "");
  check_record(folder.path(), system, 12);
}
