#include "experiments/plans/resolved_run.hpp"

#include "experiments/box/vibrated_box.hpp"
#include "experiments/run/manifest.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/row_log.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

ResolvedRun noted(const std::string& key) {
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

TEST_CASE("a run of a box: its key, its packing, its steps, and its work") {
  const PlannedRun planned{"a", "vibrated_box_small", {"scene.duration=0.06", "grains.count=20"}};
  const ResolvedRun run = resolve({"plan", {planned}}).at(0);
  CHECK(run.key == run_key(planned));
  CHECK(run.packing == packing_key(read_scene(find_scene(planned.scene), planned.overrides)));
  CHECK(run.steps == 300);  // 0.06 s of 2e-4 s
  CHECK(run.work == 20.0 * 300.0);
  // a third of the longest rain and the lid's 0.1 s at 5e-4 s, the rest's 0.05 s at 2e-4 s
  CHECK(run.packing_work == Approx(20.0 * ((1.0 + 0.1) / 5e-4 + 0.05 / 2e-4)));
}

TEST_CASE("a run of single bodies has no packing") {
  const ResolvedRun run = resolve({"plan", {{"a", "incline", {}}}}).at(0);
  CHECK(run.packing.empty());
  CHECK(run.packing_work == 0.0);
  const Scene scene = read_scene(find_scene("incline"));
  CHECK(run.work == static_cast<double>(scene.bodies.size()) * static_cast<double>(run.steps));
}

TEST_CASE("what the program is asked to do, and where it is put") {
  ResolvedRun run;
  run.run = {"a", "box", {"x=1", "y=2"}};
  run.key = "cafe";
  CHECK(run_folder("r", run) == fs::path("r/runs/cafe"));
  CHECK(run_arguments("r", run) == std::vector<std::string>{"run", "box", "--set", "x=1", "--set",
                                                            "y=2", "--packing-cache", "r/packings",
                                                            "--output", "r/runs/cafe", "--continue",
                                                            "--no-report"});
  CHECK(deposit_arguments("r", run) == std::vector<std::string>{"run", "box", "--set", "x=1",
                                                                "--set", "y=2", "--packing-cache",
                                                                "r/packings", "--deposit-only"});
}

TEST_CASE("steps are counted in the log of a run, also of one that is being written") {
  const TemporaryFolder folder;
  CHECK(steps_in_log(folder.path()) == 0);
  const fs::path log = RunFolder(folder.path()).steps_log();
  fs::create_directories(log.parent_path());
  std::ofstream(log) << "torn";
  CHECK(steps_in_log(folder.path()) == 0);
  RowWriter writer(log, RowLogHeader{"columns", 7, 3});
  for (int k = 0; k < 5; ++k) writer.append(std::vector<double>{1.0, 2.0, 3.0});
  writer.flush();
  CHECK(steps_in_log(folder.path()) == 5);
  std::ofstream(log, std::ios::app) << "half a row";
  CHECK(steps_in_log(folder.path()) == 5);
}

TEST_CASE("the index has a row for every run of every plan, with its state and what it took") {
  const TemporaryFolder folder;
  const fs::path& results = folder.path();
  note_plan(results, "second", {noted("begun"), noted("lost")});
  note_plan(results, "first", {noted("done"), noted("waiting")});
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
  note_plan(results, "plan", {noted("a")});
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
