// A plan that is killed with -9 at random moments ends with the bits of an undisturbed one.

#include "experiments/plans/plan.hpp"
#include "platform/clock.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/plans/small_plan.hpp"
#include "tests/support/killed_program.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// Runs the plan and kills the program after `seconds`. Returns its exit code, or -1 if killed.
int plan_for(double seconds, const fs::path& plan, const fs::path& results) {
  return run_and_kill(seconds, {"plan", plan.string(), "--jobs", "2", "--output", results.string()},
                      results.string() + ".log");
}

int files_in(const fs::path& folder, const std::string& suffix) {
  int count = 0;
  if (fs::is_directory(folder))
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      count += entry.path().string().ends_with(suffix);
  return count;
}

}  // namespace

TEST_CASE("a plan killed with -9 twenty times at random ends with the same bits") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("plan.toml", small_plan), whole = folder.path() / "whole";
  const Plan plan = read_plan(file);
  const Stopwatch watch;
  REQUIRE(plan_for(100.0, file, whole) == 0);
  const double undisturbed = watch.seconds();
  const std::vector<std::string> bits = bits_of(plan, whole);
  REQUIRE(bits[0] != bits[1]);

  // One plan after another until there were twenty kills, of them five in deposits and five in
  // drives, on a fast machine and on a slow one.
  Random random(20);
  int kills = 0, in_deposit = 0, in_drive = 0, elsewhere = 0;
  for (int tries = 0; kills < 20 || in_deposit < 5 || in_drive < 5; ++tries) {
    REQUIRE(tries < 20);
    const fs::path results = folder.path() / ("killed" + std::to_string(tries));
    int code = -1;
    while (code == -1) {
      code = plan_for(random.uniform(0.03, 0.35) * undisturbed, file, results);
      REQUIRE((code == -1 || code == 0));
      if (code == 0) break;
      REQUIRE(++kills < 200);
      if (files_in(results / "packings", ".bin") < 2)
        ++in_deposit;
      else if (files_in(results / "runs", "checkpoint.bin") > 0 &&
               files_in(results / "runs", "steps.csv") < 4)
        ++in_drive;
      else
        ++elsewhere;
    }
    CHECK(bits_of(plan, results) == bits);
  }
  INFO(kills << " kills, " << in_deposit << " while depositing, " << in_drive
             << " while driving; undisturbed " << undisturbed << " s");
  CHECK(kills == in_deposit + in_drive + elsewhere);
}

TEST_CASE("children die with a plan that is killed") {
  const TemporaryFolder folder;
  // The run is long: a surviving child would still be running.
  const fs::path file = folder.write(
      "plan.toml",
      "scene = \"vibrated_box_small\"\n[[run]]\nname = \"long\"\nset = [\"scene.duration=100\"]\n");
  const fs::path results = folder.path() / "results";
  const PlannedRun run = read_plan(file).runs[0];
  const fs::path log = results / "logs" / (run.key + ".log");
  const Stopwatch watch;
  {
    const auto planned =
        start_program(BALLAST_PROGRAM, {"plan", file.string(), "--output", results.string()},
                      folder.path() / "log");
    while (!fs::exists(log) && watch.seconds() < 60.0 && !planned->has_ended()) usleep(2000);
    REQUIRE(fs::exists(log));
  }
  // The folder can be used again: no process holds its lock.
  const auto next = start_program(
      BALLAST_PROGRAM,
      {"run", run.scene, "--set", run.overrides[0], "--output", run_folder(results, run).string(),
       "--packing-cache", (results / "packings").string(), "--continue", "--no-report",
       "--max-seconds", "0.2"},
      folder.path() / "next.log");
  REQUIRE(next->ends_within(30.0));
  CHECK(next->status() == 3);
}
