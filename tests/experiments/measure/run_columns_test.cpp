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
  RunSummary run = summarise(steps, facts);
  run.roll.circulation = -0.125;
  RunRow row(run);
  row.name = "made";
  row.stage = "force";
  row.key = "0123";
  row.record = record_hash(steps);
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

TEST_CASE("runs.csv has names, units and a row a run, which is read back column by column") {
  const TemporaryFolder folder;
  const RunRow was = made_up_row();
  const auto file = folder.path() / "runs.csv";
  write_whole_file(file, runs_csv(std::vector<RunRow>(2, was)));
  CsvReader reader(file);
  std::vector<std::vector<std::string>> lines;
  while (reader.next()) lines.emplace_back(reader.cells().begin(), reader.cells().end());
  REQUIRE(lines.size() == 4);
  CHECK(std::set<std::string>(lines[0].begin(), lines[0].end()).size() == lines[0].size());
  CHECK(lines[0].size() == run_columns().size() + 5);
  const auto column = [&](const std::string& name) {
    return static_cast<size_t>(std::ranges::find(lines[0], name) - lines[0].begin());
  };
  CHECK(lines[2][0] == "made");
  CHECK(lines[1][column("rise")] == "m");
  CHECK(lines[3][column("roll_top")].empty());  // what is not known

  const std::vector<RunRow> rows = read_runs_csv(file);
  REQUIRE(rows.size() == 2);
  const RunRow& row = rows.back();
  CHECK(row.name + row.stage + row.key + row.solver == "madeforce0123pgs");
  CHECK(row.record == was.record);
  for (const RunColumn& of : run_columns()) {
    INFO(of.name);
    CHECK(std::isfinite(was[of.name]) == std::isfinite(row[of.name]));
    if (std::isfinite(was[of.name])) CHECK(row[of.name] == Approx(was[of.name]).epsilon(1e-8));
  }
  CHECK(row["circulation"] == -0.125);
  CHECK_THROWS_AS(row["no such column"], std::invalid_argument);
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
