// `ballast paper`, stopped by its time limit and killed with -9 at random moments, ends with the
// records, stored states and report of an undisturbed one.

#include <map>
#include <sstream>

#include "experiments/paper/paper_data.hpp"
#include "experiments/run/run.hpp"
#include "platform/atomic_file.hpp"
#include "platform/clock.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/plans/small_plan.hpp"
#include "tests/support/killed_program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

/// One sample of a few grains: 5000 steps at 5 Hz. Whole states are stored at record.state_rate.
CampaignSettings small_campaign() {
  return {.plan = {},
          .scene = "vibrated_box_small",
          .overrides = {"grains.count=20", "box.length=0.14", "box.width=0.14",
                        "record.checkpoint_seconds=0.02", "solver.max_iterations=5"},
          .only = "motion*seed=1"};
}

std::vector<std::string> fig3(const fs::path& results, std::vector<std::string> more = {}) {
  const CampaignSettings settings = small_campaign();
  std::vector<std::string> words{"paper",     "fig3",          "--jobs",  "1",
                                 "--only",    settings.only,   "--scene", settings.scene,
                                 "--results", results.string()};
  for (const std::string& set : settings.overrides) words.insert(words.end(), {"--set", set});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The stored states by file name: poses, and the impulses from which a solver would start.
std::map<std::string, std::string> stored_states(const fs::path& run) {
  std::map<std::string, std::string> states;
  for (const fs::directory_entry& entry : fs::directory_iterator(RunFolder(run).states())) {
    const Checkpoint stored = read_checkpoint(entry.path());
    std::string bytes = bytes_of(stored.state);
    for (const Vec3& impulse : stored.memory.impulses)
      bytes.append(reinterpret_cast<const char*>(impulse.data()), 3 * sizeof(double));
    states[entry.path().filename().string()] = bytes;
  }
  return states;
}

/// The report's words and tables without the line with the time of the runs, which may differ.
std::string report_of(const fs::path& results) {
  std::istringstream text(read_whole_file(results / "report" / "README.md"));
  std::string kept;
  for (std::string line; std::getline(text, line);)
    if (line.find("core-seconds") == std::string::npos) kept += line + '\n';
  return kept + read_whole_file(results / "report" / "data" / "fig03.csv");
}

}  // namespace

TEST_CASE(
    "`ballast paper` stopped by its time limit and killed at random ends with the same records and "
    "report") {
  const TemporaryFolder folder;
  const fs::path whole = folder.path() / "whole", killed = folder.path() / "killed",
                 log = folder.path() / "log";
  const PlannedRun run = read_campaign(small_campaign()).front();
  const Stopwatch watch;
  REQUIRE(run_and_kill(200.0, fig3(whole), log) == 0);
  const double undisturbed = watch.seconds();
  const auto states = stored_states(run_folder(whole, run));
  REQUIRE(states.size() > 90);  // 1 s at 100 Hz

  const int limited =
      run_and_kill(200.0, fig3(killed, {"--max-seconds", std::to_string(0.05 * undisturbed)}), log);
  CHECK((limited == static_cast<int>(ExitCode::time_limit) || limited == 0));
  CHECK(fs::exists(killed / "report" / "README.md"));
  Random random(11);
  int kills = 0;
  // The first kills are early, the next ones later and later: other load on the machine may have
  // slowed down the undisturbed run, or slow down the killed ones, many times.
  double longest = 0.03;
  while (run_and_kill(random.uniform(0.01, longest) * undisturbed, fig3(killed), log) != 0) {
    REQUIRE(++kills < 100);
    longest *= 1.2;
  }
  INFO(kills << " kills, undisturbed " << undisturbed << " s");
  CHECK(kills > 0);
  CHECK(physics_of(run_folder(killed, run)) == physics_of(run_folder(whole, run)));
  CHECK(state_of(run_folder(killed, run)) == state_of(run_folder(whole, run)));
  CHECK((stored_states(run_folder(killed, run)) == states));
  CHECK(report_of(killed) == report_of(whole));
}
