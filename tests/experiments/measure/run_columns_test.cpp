// The row of a run: from a made-up record whose numbers are known, and as a table.

#include "experiments/measure/run_columns.hpp"

#include <set>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

RunRow made_up_row() {
  RunFacts facts = facts_of(SyntheticBox{});
  facts.grains = 1200;
  facts.solver = "pgs";
  const auto steps = synthetic_box();
  RunRow row{"made", "force", "0123", record_hash(steps), summarise(steps, facts)};
  row.run.roll.circulation = -0.125;
  return row;
}

}  // namespace

TEST_CASE("a record's hash knows every bit of its steps but the clock's") {
  std::vector<StepRecord> steps = synthetic_box();
  const std::string hash = record_hash(steps);
  steps[7].seconds_solve *= 2.0;
  CHECK(record_hash(steps) == hash);
  steps[7].wall_x = std::nextafter(steps[7].wall_x, 1.0);
  CHECK(record_hash(steps) != hash);
}

TEST_CASE("runs.csv has names, units and a row a run; what is not known is empty") {
  const TemporaryFolder folder;
  write_whole_file(folder.path() / "runs.csv", runs_csv(std::vector<RunRow>(2, made_up_row())));
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
  CHECK(std::stod(rows[2][column("rise")]) == Approx(made_up_row().run.rise.mean));
  CHECK(rows[3][column("roll_top")].empty());
  CHECK(rows[0].size() == run_columns().size() + 5);
}

TEST_CASE("a row that was written is read back, column by column") {
  const TemporaryFolder folder;
  const RunRow was = made_up_row();
  const auto file = folder.path() / "runs.csv";
  write_whole_file(file, runs_csv(std::vector<RunRow>(2, was)));
  const std::vector<RunRow> rows = read_runs_csv(file);
  REQUIRE(rows.size() == 2);
  const RunRow& row = rows.back();
  CHECK(row.name == "made");
  CHECK(row.stage == "force");
  CHECK(row.key == "0123");
  CHECK(row.record == was.record);
  CHECK(row.run.facts.solver == "pgs");
  for (const RunColumn& column : run_columns()) {
    INFO(column.name);
    const double written = column.value(was.run), read = column.value(row.run);
    CHECK(std::isfinite(written) == std::isfinite(read));
    if (std::isfinite(written)) CHECK(read == Approx(written).epsilon(1e-8));
  }
  CHECK(row.run.compaction.relative_gain == Approx(was.run.compaction.relative_gain).epsilon(1e-6));
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
  // of an earlier version, with a column that is no more
  CHECK(refusal("name,stage,key,record,solver,layer1\n" + units + "a,b,c,d,e,1\n") == "read");
  CHECK_THAT(refusal(head), Catch::Contains("units"));
  CHECK_THAT(refusal(head + units + "a,b,c,d,e,much\n"),
             Catch::Contains("runs.csv:3") && Catch::Contains("rise") && Catch::Contains("much"));
  CHECK_THAT(refusal(head + units + "a,b,c,d,e\n"), Catch::Contains("runs.csv:3"));
}
