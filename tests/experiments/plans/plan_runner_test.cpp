// The engine makes each run once, in any number of processes, whatever happens to the others.

#include <signal.h>
#include <unistd.h>

#include "experiments/plans/plan.hpp"
#include "platform/atomic_file.hpp"
#include "platform/program.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/plans/small_plan.hpp"
#include "tests/support/program.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

ProgramResult run_plan_file(const fs::path& plan, const fs::path& results,
                            std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"plan", plan.string(), "--output", results.string()});
  return ballast_program(more);
}

long entries(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

}  // namespace

TEST_CASE("two processes give the bits of one, and what is finished is not run again") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("plan.toml", small_plan), one = folder.path() / "one",
                 two = folder.path() / "two";
  const Plan plan = read_plan(file);
  CHECK_THAT(run_plan_file(file, one, {"--dry-run"}).output,
             Catch::Contains("waiting") && Catch::Contains("to deposit"));
  CHECK_FALSE(fs::exists(one));

  const ProgramResult first = run_plan_file(file, one, {"--jobs", "1"});
  CAPTURE(first.output, first.errors);
  REQUIRE(first.succeeded());
  CHECK_THAT(first.output, Catch::Contains("4 runs: 4 finished (0 of them before)"));
  const ProgramResult second = run_plan_file(file, two, {"--jobs", "2"});
  CAPTURE(second.output, second.errors);
  REQUIRE(second.succeeded());
  CHECK(bits_of(plan, one) == bits_of(plan, two));
  for (const PlannedRun& run : plan.runs) CHECK(is_finished(one, run));
  CHECK(entries(one / "packings") == 2);  // each is shared by two runs
  CHECK_FALSE(fs::exists(one / "plan.lock"));

  const fs::path manifest = run_folder(one, plan.runs[0]) / "manifest.json";
  const auto written = fs::last_write_time(manifest);
  CHECK_THAT(run_plan_file(file, one).output,
             Catch::Contains("4 runs: 4 finished (4 of them before)"));
  CHECK(fs::last_write_time(manifest) == written);
  CHECK_THAT(run_plan_file(file, one, {"--dry-run"}).output,
             Catch::Contains("finished") && !Catch::Contains("waiting"));
  const std::string index = read_whole_file(one / "index.csv");
  CHECK(std::count(index.begin(), index.end(), '\n') == 5);
  CHECK_THAT(index, Catch::Contains("small,nu-drive.frequency=20-grains.seed=1," +
                                    plan.runs[0].key + ",finished,300,300,"));
}

TEST_CASE("a run that fails is reported and the others go on") {
  const TemporaryFolder folder;
  const fs::path results = folder.path() / "results";
  const fs::path file = folder.write("plan.toml", std::string(small_plan) + R"(
[[run]]
name = "restless"
set = ["deposit.max_time=0.01", "deposit.rest_velocity=1e-9"]
[[run]]
name = "taken"
set = ["drive.frequency=30"]
)");
  const Plan plan = read_plan(file);
  const PlannedRun &restless = plan.runs[0], &taken = plan.runs[1];
  fs::create_directories(run_folder(results, taken));
  write_whole_file(run_folder(results, taken) / "scene.toml", "not what it should be\n");

  const ProgramResult result = run_plan_file(file, results, {"--jobs", "2"});
  CAPTURE(result.output, result.errors);
  CHECK_THAT(result.output,
             Catch::Contains("FAILED    packing of restless: deposit: after deposit.max_time"));
  CHECK_THAT(result.output,
             Catch::Contains("FAILED    restless: packing of restless failed (" +
                             (results / "logs" / ("packing-" + restless.packing)).string()));
  check_failure(result, ExitCode::failure, {"plan small: 2 of 6 runs failed; first: "});
  CHECK_THAT(result.output, Catch::Contains("FAILED    taken: ") &&
                                Catch::Contains("holds a run of other settings"));
  CHECK_THAT(result.output, Catch::Contains("6 runs: 4 finished (0 of them before), 2 failed"));
  CHECK_THAT(read_whole_file(results / "index.csv"),
             Catch::Contains("restless," + restless.key + ",failed"));

  fs::remove_all(run_folder(results, taken));  // mended: the run is tried again
  const ProgramResult again = run_plan_file(file, results, {"--only", "taken"});
  CHECK(again.succeeded());
  CHECK(is_finished(results, taken));
}

TEST_CASE("a plan's lines for a shell give the bits of the engine, part by part and in any order") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("plan.toml", small_plan), engine = folder.path() / "engine",
                 results = folder.path() / "two 'words'";
  const Plan plan = read_plan(file);
  REQUIRE(run_plan_file(file, engine).succeeded());
  const auto lines_left = [&] {
    return split(run_plan_file(file, results, {"--commands"}).output, '\n').size() - 1;
  };
  CHECK(lines_left() == 6);
  CHECK(fs::is_empty(results / "runs"));
  const auto run_lines = [&](const std::string& filter, std::vector<std::string> more) {
    more.insert(more.begin(), {"plan", file, "--output", results, "--commands"});
    return ballast_in_shell("\"$@\" | " + filter + " | xargs -P 2 -d '\\n' -n 1 sh -c", more)
        .succeeded();
  };
  // For two runs with the same packing, one line deposits it and the other waits.
  CHECK(run_lines("grep -v deposit-only", {"--only", "*seed=1"}));
  CHECK(lines_left() == 3);
  CHECK(run_lines("tac", {}));
  CHECK(lines_left() == 0);
  CHECK(bits_of(plan, results) == bits_of(plan, engine));
  CHECK_THAT(run_plan_file(file, results).output,
             Catch::Contains("4 runs: 4 finished (4 of them before)"));
}

TEST_CASE("the time limit stops a plan with checkpoints, and the same command goes on") {
  const TemporaryFolder folder;
  const fs::path file = folder.write("plan.toml", small_plan), results = folder.path() / "results";
  int stops = 0;
  double seconds = 0.02;  // less than any machine needs
  ProgramResult result = run_plan_file(file, results, {"--max-seconds", std::to_string(seconds)});
  while (result.status == static_cast<int>(ExitCode::time_limit)) {
    REQUIRE(++stops < 200);
    check_failure(result, ExitCode::time_limit, {"the same command goes on"});
    seconds *= 1.1;  // so that it ends under sanitizers and beside other work too
    result = run_plan_file(file, results, {"--max-seconds", std::to_string(seconds)});
  }
  CHECK(stops > 0);
  CHECK(result.succeeded());
}

TEST_CASE("SIGTERM stops every run with a checkpoint, meanwhile nobody else runs a plan there") {
  const TemporaryFolder folder;
  const fs::path results = folder.path() / "results", log = folder.path() / "log";
  const fs::path file =
      folder.write("plan.toml", std::string(small_plan) +
                                    "[[run]]\nname = \"long\"\nset = [\"scene.duration=100\", "
                                    "\"record.checkpoint_seconds=1000\"]\n");
  const fs::path run = run_folder(results, read_plan(file).runs[0]);
  const auto long_plan =
      start_program(BALLAST_PROGRAM,
                    {"plan", file.string(), "--output", results.string(), "--only", "long"}, log);
  for (int k = 0; k < 6000 && !fs::exists(run / "log" / "steps.bin") && !long_plan->has_ended();
       ++k)
    usleep(10'000);
  REQUIRE(fs::exists(run / "log" / "steps.bin"));
  check_failure(run_plan_file(file, results), ExitCode::failure,
                {results.string(), "is working there"});
  CHECK_FALSE(fs::exists(run / "checkpoint.bin"));
  long_plan->send(SIGTERM);
  REQUIRE(long_plan->ends_within(60.0));
  CHECK(long_plan->status() == static_cast<int>(ExitCode::failure));
  CHECK_THAT(last_line(log), Catch::Contains("the same command goes on"));
  CHECK(read_checkpoint(run / "checkpoint.bin").state.step > 0);
}

TEST_CASE("a plan's command line and plan are checked before anything is written") {
  const TemporaryFolder folder;
  const fs::path results = folder.path() / "results", file = folder.write("plan.toml", small_plan);
  check_failure(run_plan_file(folder.path() / "none.toml", results), ExitCode::failure,
                {"none.toml"});
  check_failure(run_plan_file(file, results, {"--jobs", "0"}), ExitCode::usage, {"--jobs"});
  check_failure(run_plan_file(file, results, {"--max-seconds", "-1"}), ExitCode::usage,
                {"--max-seconds"});
  check_failure(run_plan_file(file, results, {"--only", "mu*"}), ExitCode::failure,
                {"no run is named like mu*"});
  CHECK_FALSE(fs::exists(results));
}
