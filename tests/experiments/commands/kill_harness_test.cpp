// A short form of scripts/kill_harness.sh, which kills the program a hundred times.

#include "tests/support/program.hpp"

using namespace ballast;

TEST_CASE(
    "killed at random, a run, a deposit and a comparison end with the bits of undisturbed ones") {
  const ProgramResult result = run_program(
      BALLAST_SOURCE_FOLDER "/scripts/kill_harness.sh",
      {"--ballast", BALLAST_PROGRAM, "--kills", "6", "--only", "run deposit compare"}, 600.0);
  INFO(result.output << result.errors);
  CHECK(result.status == 0);
  CHECK(result.errors.empty());
  for (const char* activity : {"| run |", "| deposit |", "| compare |"})
    CHECK_THAT(result.output, Catch::Contains(activity));
}
