// What a plan has to do, and how far it is.

#include "experiments/plans/plan_runner.hpp"

#include <iostream>

#include "experiments/run/run_folder.hpp"
#include "platform/row_log.hpp"
#include "platform/text.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// What goes to a stream while this lives.
class Heard {
 public:
  explicit Heard(std::ostream& stream) : stream_(stream), old_(stream.rdbuf(text_.rdbuf())) {}
  ~Heard() { stream_.rdbuf(old_); }
  std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::ostream& stream_;
  std::streambuf* old_;
};

/// Two runs of equal work, of which one has 30 of its 40 steps, and a deposit that is going on.
std::vector<Task> tasks_in(const fs::path& folder) {
  Task deposit, begun, waiting;
  deposit.state = TaskState::running;
  begun.folder = folder / "begun";
  begun.state = TaskState::running;
  waiting.folder = folder / "waiting";
  for (Task* run : {&begun, &waiting}) {
    run->steps = 40;
    run->work = 100.0;
  }
  fs::create_directories(begun.folder / "log");
  RowWriter log(RunFolder(begun.folder).steps_log(), RowLogHeader{"", 0, 1});
  for (int k = 0; k < 30; ++k) log.append(std::vector<double>{0.0});
  log.flush();
  return {deposit, begun, waiting};
}

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

TEST_CASE("how far a plan is: by the work done, the steps in the logs included") {
  const TemporaryFolder folder;
  std::vector<Task> tasks = tasks_in(folder.path());
  const Heard errors(std::cerr);
  PlanProgress progress(StatusLine::Style::lines, tasks);
  progress.show(1.0);  // too early for a line
  CHECK(errors.text().empty());
  progress.show(100.0);
  CHECK_THAT(errors.text(), Catch::Contains("37 %  0 of 2 runs, 1 running, 1 depositing"));
  CHECK(errors.text().find("left") == std::string::npos);  // nothing gained yet
  tasks[0].state = tasks[1].state = TaskState::finished;
  tasks[2].state = TaskState::failed;
  progress.show(200.0);
  // 25 of the 125 that were to do took 200 s: the other 100 take 800 s
  CHECK_THAT(errors.text(), Catch::Contains("50 %  1 of 2 runs, 0 running, 1 FAILED  " +
                                            duration_text(800.0) + " left"));
}

TEST_CASE("what happens is said on stdout, unless quiet") {
  const std::vector<Task> tasks;
  for (const bool quiet : {false, true}) {
    const Heard out(std::cout), errors(std::cerr);
    PlanProgress progress(quiet ? StatusLine::Style::quiet : StatusLine::Style::lines, tasks);
    progress.say("finished  a");
    progress.show(1000.0);
    CHECK(out.text() == (quiet ? "" : "finished  a\n"));
    CHECK(errors.text().empty() == quiet);
  }
}

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
