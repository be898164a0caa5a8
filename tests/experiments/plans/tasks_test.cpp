#include "experiments/plans/plan_runner.hpp"

#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

ResolvedRun run(const std::string& key, const std::string& packing, double work) {
  ResolvedRun resolved;
  resolved.run.name = "run " + key;
  resolved.key = key;
  resolved.packing = packing;
  resolved.work = work;
  resolved.packing_work = 10 * work;
  return resolved;
}

std::vector<std::string> titles(const std::vector<Task>& tasks) {
  std::vector<std::string> all;
  for (const Task& task : tasks) all.push_back(task.title);
  return all;
}

}  // namespace

TEST_CASE("packings come first, both longest first, and each run waits for its own") {
  const TemporaryFolder folder;
  const std::vector<Task> tasks = make_tasks(
      folder.path(), {run("a", "p", 1), run("b", "q", 3), run("c", "p", 2), run("d", "", 4)});
  CHECK(titles(tasks) == std::vector<std::string>{"packing of run b", "packing of run a", "run d",
                                                  "run b", "run c", "run a"});
  CHECK(tasks[2].deposit == -1);
  CHECK(tasks[3].deposit == 0);
  CHECK(tasks[4].deposit == 1);
  CHECK(tasks[5].deposit == 1);
  for (size_t k = 0; k < tasks.size(); ++k) {
    CHECK(tasks[k].is_run() == (k >= 2));
    CHECK(tasks[k].state == TaskState::waiting);
  }
}

TEST_CASE("a packing that is there is not deposited; one run under two names is one task") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "packings");
  std::ofstream(folder.path() / "packings" / "packing-p.bin") << "there";
  ResolvedRun twin = run("a", "p", 1);
  twin.run.name = "another name";
  const std::vector<Task> tasks = make_tasks(folder.path(), {run("a", "p", 1), twin});
  REQUIRE(tasks.size() == 1);
  CHECK(tasks[0].title == "run a");
  CHECK(tasks[0].deposit == -1);
}

TEST_CASE("a run with a damaged manifest is not finished") {
  const TemporaryFolder folder;
  const fs::path run_folder = folder.path() / "runs" / "a";
  fs::create_directories(run_folder);
  for (const char* name : {"manifest.json", "steps.csv", "record.h5"})
    std::ofstream(run_folder / name) << "no JSON";
  CHECK(make_tasks(folder.path(), {run("a", "", 1)})[0].state == TaskState::waiting);
}
