// The row of a run: from a made-up record whose numbers are known, and as a table.

#include "experiments/paper/run_observables.hpp"

#include <cmath>
#include <set>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

namespace {

RunData made_up_run(const fs::path& results, std::vector<std::string> overrides = {}) {
  const PlannedRun run{"made", "vibrated_box", std::move(overrides)};
  write_run(results, run);
  return read_run_data(folder_of(results, run));
}

}  // namespace

TEST_CASE("a run's row says what was set and what its record holds") {
  const TemporaryFolder folder;
  const RunObservables run = observe_run(made_up_run(
      folder.path(), {"grains.seed=3", "drive.lid_raise=0.02", "solver.max_iterations=77"}));
  CHECK(run.setup.seed == 3);
  CHECK(run.setup.lid_raise == 0.02);
  CHECK(run.setup.iterations_most == 77);
  CHECK(run.setup.grains == 1200);
  CHECK(run.setup.length == 0.54);
  CHECK(run.setup.largest_size == 0.05);
  CHECK(run.force_over_weight() == Approx(3.0));
  CHECK(run.wall_mass_over_grains() == Approx(0.5));
  CHECK(run.prefactor() == Approx(0.02).epsilon(1e-3));
  // rho grows evenly: what the stroke out and the way back gain is a period's gain and the jam's
  // before the stroke
  CHECK(run.gains.extension > 0.0);
  CHECK(run.gains.extension + run.gains.contraction == Approx(run.seen.gain).epsilon(0.02));
  // the record without poses
  CHECK(std::isnan(run.before.as_run));
  CHECK(std::isnan(run.roll.circulation));
}

TEST_CASE("a record's hash knows every bit of its steps but the clock's") {
  const TemporaryFolder folder;
  std::vector<StepRecord> steps = made_up_run(folder.path()).steps;
  const std::string hash = record_hash(steps);
  steps[7].seconds_solve *= 2.0;
  CHECK(record_hash(steps) == hash);
  steps[7].wall_x = std::nextafter(steps[7].wall_x, 1.0);
  CHECK(record_hash(steps) != hash);
}

TEST_CASE("runs.csv has names, units and a row a run; what is not known is empty") {
  const TemporaryFolder folder;
  RunObservables run = observe_run(made_up_run(folder.path()));
  run.name = "made";
  write_whole_file(folder.path() / "runs.csv", runs_csv(std::vector<RunObservables>{run, run}));
  CsvReader reader(folder.path() / "runs.csv");
  std::vector<std::vector<std::string>> rows;
  while (reader.next()) rows.emplace_back(reader.cells().begin(), reader.cells().end());
  REQUIRE(rows.size() == 4);
  CHECK(std::set<std::string>(rows[0].begin(), rows[0].end()).size() == rows[0].size());
  const auto column = [&](const std::string& name) {
    return static_cast<size_t>(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  CHECK(rows[2][0] == "made");
  CHECK(rows[1][column("rise")] == "m");
  CHECK(std::stod(rows[2][column("rise")]) == Approx(run.seen.rise));
  CHECK(rows[3][column("circulation")].empty());
  CHECK(rows[0].size() == run_columns().size() + 5);
}
