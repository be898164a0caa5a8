// The row of a run: from a made-up record whose numbers are known, and as a table.

#include "experiments/paper/run_observables.hpp"

#include <cmath>
#include <set>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
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

TEST_CASE("a row that was written is read back, column by column") {
  const TemporaryFolder folder;
  RunObservables run = observe_run(made_up_run(folder.path()));
  run.name = "made";
  run.stage = "force";
  run.key = "0123";
  run.roll.circulation = -0.125;
  const auto file = folder.path() / "runs.csv";
  write_whole_file(file, runs_csv(std::vector<RunObservables>{run, run}));
  const std::vector<RunObservables> rows = read_runs_csv(file);
  REQUIRE(rows.size() == 2);
  const RunObservables& row = rows.back();
  CHECK(row.name == "made");
  CHECK(row.stage == "force");
  CHECK(row.key == "0123");
  CHECK(row.record == run.record);
  CHECK(row.setup.solver == run.setup.solver);
  for (const RunColumn& column : run_columns()) {
    INFO(column.name);
    const double was = column.value(run), is = column.value(row);
    CHECK(std::isfinite(was) == std::isfinite(is));
    if (std::isfinite(was)) CHECK(is == Approx(was).epsilon(1e-8));
  }
  CHECK(row.seen.eq3_one_grain() == Approx(run.seen.eq3_one_grain()).epsilon(1e-8));
  CHECK(row.seen.relative_gain == Approx(run.seen.relative_gain).epsilon(1e-6));
}

TEST_CASE("a table that is no runs.csv is refused by its file, line and column") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "runs.csv";
  const std::string head = "name,stage,key,record,solver,rise\n",
                    units = "text,text,text,text,text,m\n";
  const auto refusal = [&](const std::string& text) -> std::string {
    write_whole_file(file, text);
    try {
      read_runs_csv(file);
    } catch (const Error& error) {
      return error.what();
    }
    return "read";
  };
  CHECK(refusal(head + units + "a,b,c,d,e,0.5\n") == "read");
  CHECK(refusal(head + units + "a,b,c,d,e,\n") == "read");
  CHECK(refusal("name,stage,key,record,solver,periods\n" + units + "a,b,c,d,e,1e300\n") == "read");
  CHECK_THAT(refusal(""), Catch::Contains("runs.csv") && Catch::Contains("empty"));
  CHECK_THAT(refusal("name,rise\n"), Catch::Contains("runs.csv:1") && Catch::Contains("begins"));
  CHECK_THAT(refusal("name,stage,key,record,solver,risen\n"),
             Catch::Contains("runs.csv:1") && Catch::Contains("'risen'"));
  CHECK_THAT(refusal(head), Catch::Contains("units"));
  CHECK_THAT(refusal(head + units + "a,b,c,d,e,much\n"),
             Catch::Contains("runs.csv:3") && Catch::Contains("rise") && Catch::Contains("much"));
  CHECK_THAT(refusal(head + units + "a,b,c,d,e\n"), Catch::Contains("runs.csv:3"));
}
