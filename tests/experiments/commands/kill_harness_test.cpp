// A short form of scripts/kill_harness.sh, which kills the program a hundred times.

#include "platform/atomic_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

ProgramResult harness(const std::string& program, const std::string& kills,
                      const std::string& only) {
  return run_program(BALLAST_SOURCE_FOLDER "/scripts/kill_harness.sh",
                     {"--ballast", program, "--kills", kills, "--only", only}, 600.0);
}

}  // namespace

TEST_CASE(
    "killed at random, a run, a deposit and a comparison end with the bits of undisturbed ones") {
  const ProgramResult result = harness(BALLAST_PROGRAM, "6", "run deposit compare");
  INFO(result.output << result.errors);
  CHECK(result.status == 0);
  CHECK(result.errors.empty());
  for (const char* activity : {"| run |", "| deposit |", "| compare |"})
    CHECK_THAT(result.output, Catch::Contains(activity));
}

TEST_CASE("the harness finds bits that are not the same, and a program that fails") {
  const TemporaryFolder folder;
  // begun in the folder of the first killed one it deposits other grains
  const fs::path other = folder.write(
      "other", "#!/bin/sh\ncase \"$*\" in *deposit.1*) exec " BALLAST_PROGRAM
               " \"$@\" --set grains.seed=99 ;; esac\nexec " BALLAST_PROGRAM " \"$@\"\n");
  const fs::path failing =
      folder.write("failing",
                   "#!/bin/sh\ncase \"$*\" in *deposit.1*) sleep 0.2; echo no >&2; exit 1 ;; esac\n"
                   "exec " BALLAST_PROGRAM " \"$@\"\n");
  for (const fs::path& program : {other, failing}) fs::permissions(program, fs::perms::owner_all);
  const ProgramResult differs = harness(other.string(), "1", "deposit");
  CHECK(differs.status == 1);
  CHECK_THAT(differs.errors, Catch::Contains("other bits than undisturbed"));
  const ProgramResult fails = harness(failing.string(), "1", "deposit");
  CHECK(fails.status == 1);
  CHECK_THAT(fails.errors, Catch::Contains("exit code 1: no"));
}
