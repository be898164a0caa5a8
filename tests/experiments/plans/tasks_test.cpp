// The tasks of a plan, its progress, and the state that its folder shows.

#include "experiments/plans/plan_runner.hpp"
#include "platform/row_log.hpp"
#include "platform/text.hpp"
#include "tests/experiments/plans/small_plan.hpp"
#include "tests/support/sample_run.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

PlannedRun run(const std::string& key, const std::string& packing, double work) {
  return {"run " + key, "incline", {"a.b=1"}, key, packing, 40, work, 10 * work};
}

/// A folder as a run leaves it `left` steps before its end.
void put_run(const fs::path& results, const std::string& key, double left) {
  const RunFolder folder(results / "runs" / key);
  Manifest manifest("incline", {}, key);
  folder.begin("scene", manifest, false);
  manifest.summary("drive_seconds", 12.5);
  manifest.summary("error_mean_relative", 1e-3);
  manifest.summary(steps_left_entry, left);
  manifest.write(folder.manifest());
  for (const char* name : {"steps.csv", "record.h5"}) put_bytes(folder.path() / name, "");
}

/// The log of a run with this number of steps.
void put_steps(const fs::path& folder, int steps) {
  fs::create_directories(folder / "log");
  RowWriter log(RunFolder(folder).steps_log(), RowLogHeader{"columns", 7, 3});
  for (int k = 0; k < steps; ++k) log.append(std::vector<double>{1.0, 2.0, 3.0});
  log.flush();
}

}  // namespace

TEST_CASE("steps are counted in the log of a run, also of one that is being written") {
  const TemporaryFolder folder;
  CHECK(steps_in_log(folder.path()) == 0);
  put_steps(folder.path(), 5);
  const fs::path log = RunFolder(folder.path()).steps_log();
  std::ofstream(log, std::ios::app) << "half a row";
  CHECK(steps_in_log(folder.path()) == 5);
  put_bytes(log, "torn");
  CHECK(steps_in_log(folder.path()) == 0);
}

TEST_CASE("how far a plan is: by the work done, the steps in the logs included") {
  const TemporaryFolder folder;
  Task deposit, begun, waiting;
  deposit.state = begun.state = TaskState::running;
  begun.folder = folder.path() / "begun";
  waiting.folder = folder.path() / "waiting";
  begun.steps = waiting.steps = 40;
  begun.work = waiting.work = 100.0;
  put_steps(begun.folder, 30);
  std::vector<Task> tasks{deposit, begun, waiting};
  const double before = work_done(tasks);
  // Without progress the remaining time is unknown.
  CHECK(plan_progress(tasks, before, 100.0) == " 37 %  0 of 2 runs, 1 running, 1 depositing");
  tasks[0].state = tasks[1].state = TaskState::finished;
  tasks[2].state = TaskState::failed;
  // 25 of the 125 units of work left at the start took 200 s: the other 100 take 800 s.
  CHECK(plan_progress(tasks, before, 200.0) ==
        " 50 %  1 of 2 runs, 0 running, 1 FAILED  " + duration_text(800.0) + " left");
}

TEST_CASE("packings come first, both longest first, and each run waits for its own") {
  const TemporaryFolder folder;
  const std::vector<Task> tasks = make_tasks(
      folder.path(), {run("a", "p", 1), run("b", "q", 3), run("c", "p", 2), run("d", "", 4)});
  std::vector<std::pair<std::string, int>> found;
  for (const Task& task : tasks) {
    found.emplace_back(task.title, task.deposit);
    CHECK(task.state == TaskState::waiting);
  }
  CHECK(found == std::vector<std::pair<std::string, int>>{{"packing of run b", -1},
                                                          {"packing of run c", -1},
                                                          {"run d", -1},
                                                          {"run b", 0},
                                                          {"run c", 1},
                                                          {"run a", 1}});
  CHECK((!tasks[1].is_run() && tasks[2].is_run()));
  // The arguments with which the program is called.
  using Words = std::vector<std::string>;
  const std::string packings = (folder.path() / "packings").string();
  CHECK(tasks[1].arguments ==
        Words{"run", "incline", "--set", "a.b=1", "--packing-cache", packings, "--deposit-only"});
  CHECK(tasks[5].arguments == Words{"run", "incline", "--set", "a.b=1", "--packing-cache", packings,
                                    "--output", (folder.path() / "runs" / "a").string(),
                                    "--continue", "--no-report"});
}

TEST_CASE("what is there is not made again, one run under two names is one task") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "packings");
  put_bytes(folder.path() / "packings" / "packing-p.bin", "there");
  PlannedRun twin = run("a", "p", 1);
  twin.name = "another name";
  put_run(folder.path(), "done", 0);
  put_run(folder.path(), "damaged", 0);
  put_bytes(folder.path() / "runs" / "damaged" / "manifest.json", "no JSON");
  const std::vector<Task> tasks = make_tasks(
      folder.path(), {run("a", "p", 4), twin, run("done", "q", 3), run("damaged", "", 2)});
  REQUIRE(tasks.size() == 3);
  CHECK((tasks[0].title == "run a" && tasks[0].deposit == -1));
  CHECK(tasks[1].state == TaskState::finished);
  CHECK(tasks[2].state == TaskState::waiting);
}

TEST_CASE("the index has a row for every run of every plan, with its state and what it took") {
  const TemporaryFolder folder;
  const fs::path& results = folder.path();
  put_run(results, "done", 0);
  put_run(results, "begun", 7);
  put_run(results, "damaged", 7);
  put_bytes(results / "runs" / "damaged" / "manifest.json", "{");
  write_index(results, {"b", {run("done", "", 1)}}, {});
  write_index(results, {"a", {run("begun", "", 1)}}, {"begun"});
  write_index(
      results,
      {"a",
       {run("begun", "", 1), run("lost", "", 1), run("waiting", "", 1), run("damaged", "", 1)}},
      {"lost"});
  const std::string facts =
      "12.5,0.001," + Manifest::read(results / "runs/done/manifest.json").commit();
  CHECK(file_bytes(results / "index.csv") ==
        "plan,name,key,state,steps_done,steps,seconds,error_mean,commit\n"
        "a,run begun,begun,begun,0,40," +
            facts +
            "\n"
            "a,run lost,lost,failed,0,40,,,\n"
            "a,run waiting,waiting,waiting,0,40,,,\n"
            "a,run damaged,damaged,begun,0,40,,,\n"
            "b,run done,done,finished,40,40," +
            facts + "\n");
}
