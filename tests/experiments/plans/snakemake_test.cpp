#include <nlohmann/json.hpp>

#include "experiments/plans/plan_runner.hpp"
#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/plans/small_plan.hpp"
#include "tests/support/program.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a plan for a cluster: every run and packing is a job, and nothing is run") {
  const TemporaryFolder folder;
  const fs::path results = folder.path() / "results", jobs = folder.path() / "jobs",
                 file = folder.write("plan.toml", small_plan);
  const Plan plan = read_plan(file);
  const PlanOptions all{.results = results};
  write_snakemake(plan, file, all, BALLAST_PROGRAM, jobs);
  CHECK(fs::is_empty(results / "runs"));
  const auto list = nlohmann::json::parse(read_whole_file(jobs / "runs.json"));
  CHECK(list["runs"].size() == 4);
  CHECK(list["packings"].size() == 2);
  for (size_t k = 0; k < plan.runs.size(); ++k) {
    const std::string key = plan.runs[k].key;
    REQUIRE(list["runs"].contains(key));
    std::vector<std::string> words = list["runs"][key]["arguments"];
    CHECK(fs::path(words[1]).is_absolute());
    CHECK(std::find(words.begin(), words.end(), run_folder(results, plan.runs[k]).string()) !=
          words.end());
    if (k > 0) continue;
    REQUIRE(ballast_program(words).succeeded());  // as a job would
    CHECK(is_finished(results, plan.runs[k]));
  }
  CHECK((fs::status(jobs / "slurm" / "status.sh").permissions() & fs::perms::owner_exec) !=
        fs::perms::none);
  CHECK_THROWS_WITH(write_snakemake(plan, file, all, BALLAST_PROGRAM, folder.path() / "with blank"),
                    Catch::Contains("with blank"));

  // the last rule asks the program whether all is finished
  CHECK(list["program"] == BALLAST_PROGRAM);
  CHECK_THAT(read_whole_file(jobs / "Snakefile"), Catch::Contains("PLAN[\"finish\"]"));
  const ProgramResult finish = ballast_program(list["finish"]);
  CHECK(finish.succeeded());
  CHECK_THAT(finish.output, Catch::Contains("4 runs: 4 finished (1 of them before)"));
  // of a part of the plan it asks for that part
  write_snakemake(plan, file, {.results = results, .only = plan.runs[0].name}, BALLAST_PROGRAM,
                  folder.path() / "one");
  const auto one = nlohmann::json::parse(read_whole_file(folder.path() / "one" / "runs.json"));
  CHECK(one["runs"].size() == 1);
  CHECK_THAT(ballast_program(one["finish"]).output, Catch::Contains("1 runs: 1 finished"));
  // the profile names this folder, and no mark is left to be filled in
  const std::string profile = read_whole_file(jobs / "slurm" / "config.yaml");
  CHECK_THAT(profile, Catch::Contains(jobs.string() + "/slurm/status.sh"));
  CHECK(profile.find('@') == std::string::npos);
}
