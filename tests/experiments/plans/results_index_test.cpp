#include "experiments/plans/results_index.hpp"

#include "experiments/run/manifest.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

ResolvedRun run(const std::string& key) {
  ResolvedRun resolved;
  resolved.run = {"name-" + key, "incline", {"a.b=1"}};
  resolved.key = key;
  resolved.steps = 40;
  return resolved;
}

/// A folder as a run leaves it, `left` steps before its end.
void put_run(const fs::path& results, const std::string& key, double left) {
  const RunFolder folder(results / "runs" / key);
  Manifest manifest("incline", {}, key);
  folder.begin("scene", manifest, false);
  manifest.summary("drive_seconds", 12.5);
  manifest.summary("error_mean_relative", 1e-3);
  manifest.summary(steps_left_entry, left);
  manifest.write(folder.manifest());
  for (const char* name : {"steps.csv", "record.h5"}) write_whole_file(folder.path() / name, "");
}

}  // namespace

TEST_CASE("the index has a row for every run of every plan, with its state and what it took") {
  const TemporaryFolder folder;
  const fs::path& results = folder.path();
  note_plan(results, "second", {run("begun"), run("lost")});
  note_plan(results, "first", {run("done"), run("waiting")});
  put_run(results, "done", 0);
  put_run(results, "begun", 7);
  write_index(results, {{"lost", "why"}});
  const std::string commit = Manifest::read(results / "runs" / "done" / "manifest.json").commit();
  CHECK(read_whole_file(results / "index.csv") ==
        "plan,name,key,state,steps_done,steps,seconds,error_mean,commit\n"
        "first,name-done,done,finished,40,40,12.5,0.001," +
            commit +
            "\n"
            "first,name-waiting,waiting,waiting,0,40,,,\n"
            "second,name-begun,begun,begun,0,40,12.5,0.001," +
            commit +
            "\n"
            "second,name-lost,lost,failed,0,40,,,\n");
}

TEST_CASE("a damaged manifest costs its row's facts, a damaged plan is an error that names it") {
  const TemporaryFolder folder;
  const fs::path& results = folder.path();
  note_plan(results, "plan", {run("a")});
  put_run(results, "a", 0);
  write_whole_file(results / "runs" / "a" / "manifest.json", "{");
  write_index(results, {});
  CHECK_THAT(read_whole_file(results / "index.csv"),
             Catch::Contains("plan,name-a,a,begun,0,40,,,\n"));
  write_whole_file(results / "plans" / "plan.json", "{\"plan\": \"plan\"}");
  CHECK_THROWS_WITH(
      write_index(results, {}),
      Catch::EndsWith("plan.json: is no plan that ballast noted: " + std::string(broken_json)));
}
