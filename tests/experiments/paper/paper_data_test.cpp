// Stored runs beside runs of which only a row is known, and statistics over rows.

#include "experiments/paper/paper_data.hpp"

#include <set>

#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/error.hpp"
#include "tests/experiments/paper/paper_runs.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

const Selection frequencies = "frequency";

bool is_first_sample(const PlannedRun&, const Scene& scene) {
  return scene.grains->seed == 1 && (scene.drive.frequency == 5.0 || scene.drive.frequency == 20.0);
}

PaperData with_rows(const TemporaryFolder& folder, const CampaignSettings& settings,
                    const std::vector<RunRow>& rows) {
  return PaperData(read_campaign(settings), folder.path(), rows);
}

/// The rows of the stage frequency. Other stages share some of its runs.
std::vector<RunRow> frequency_rows(const TemporaryFolder& folder) {
  std::vector<RunRow> rows = written(folder.path(), {"frequency"}, {}, is_first_sample).rows();
  std::erase_if(rows, [](const RunRow& row) { return row.stage != "frequency"; });
  return rows;
}

/// A group with a row for each rise, with seeds from 1 on.
Group group_of(double value, const std::vector<double>& rises, std::vector<RunRow>& rows) {
  Group group{value, "", {}};
  for (size_t k = 0; k < rises.size(); ++k) {
    RunRow& row = rows.emplace_back();
    row["seed"] = static_cast<double>(k + 1);
    row["frequency"] = value;
    row["rise"] = rises[k];
    group.samples.push_back(&row);
  }
  return group;
}

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

TEST_CASE("a row stands for its run: it is drawn as if it were there, and not made again") {
  const TemporaryFolder there, here;
  const std::vector<RunRow> rows = frequency_rows(there);
  REQUIRE(rows.size() == 2);
  PaperData data = with_rows(here, {}, rows);
  CHECK(data.finished() == 0);
  CHECK(data.known_by_row() == 2);
  CHECK(data.records("frequency").empty());
  const Groups groups = data.groups(frequencies, "frequency");
  REQUIRE(groups.size() == 2);
  CHECK(groups[1].value == 20.0);
  CHECK((*groups[1].samples.front())["rise"] == rows[1]["rise"]);
  CHECK(data.missing("frequency") == "PARTIAL: 2 of 27 runs of frequency.");
  size_t planned = 0;
  for (const Plan& stage : stages_of(data, "frequency")) planned += stage.runs.size();
  CHECK(planned == 25);
}

TEST_CASE("a run whose row was given and that was made here tells whether both are the same") {
  const TemporaryFolder there, here;
  std::vector<RunRow> rows = frequency_rows(there);
  written(here.path(), {"frequency"}, {}, is_first_sample);
  CHECK(with_rows(here, {}, {}).repeats() == std::pair(0, 0));
  CHECK(with_rows(here, {}, rows).repeats() == std::pair(2, 2));
  rows.front().record[0] ^= 1;
  PaperData other = with_rows(here, {}, rows);
  CHECK(other.repeats() == std::pair(2, 1));
  CHECK(other.known_by_row() == 0);
  // A record without poses is measured, with a notice.
  CHECK(other.notices().size() == 2);
  CHECK_THAT(other.notices().front(), Catch::Contains("No poses") && Catch::Contains("record.h5"));
}

TEST_CASE("rows of another campaign are counted, and drawn where no run stands in their place") {
  const TemporaryFolder there, here;
  std::vector<RunRow> rows = frequency_rows(there);
  for (RunRow& row : rows) {
    row.key += "0";
    row["rise"] = 7.0;
  }
  written(here.path(), {"frequency"}, {}, [](const PlannedRun& run, const Scene& scene) {
    return is_first_sample(run, scene) && scene.drive.frequency == 5.0;
  });
  PaperData data = with_rows(here, {}, rows);
  CHECK(data.foreign() == 2);
  CHECK(data.rows(frequencies).size() == 3);
  const Groups groups = data.groups(frequencies, "frequency");
  REQUIRE(groups.size() == 2);
  REQUIRE(groups[0].samples.size() == 1);
  CHECK((*groups[0].samples.front())["rise"] != 7.0);
  CHECK((*groups[1].samples.front())["rise"] == 7.0);
  CHECK(data.settings(frequencies).size() == 2);
}

TEST_CASE("targets are sections and stages, an unknown one is refused with what there is") {
  const TemporaryFolder folder;
  const PaperData data = with_rows(folder, {}, {});
  const std::vector<std::string> targets = paper_targets(data.campaign());
  CHECK(targets.front() == "curve");
  CHECK(targets.back() == "all");
  std::set<std::string> drawn, stages;
  for (const ReportSection& section : paper_sections()) {
    INFO(section.name);
    CHECK_FALSE(page::words(section.name + std::string(".heading")).empty());
    drawn.insert(section.stages.begin(), section.stages.end());
  }
  for (const PlannedRun& run : data.campaign()) CHECK(drawn.contains(stage_of(run)));
  for (const Plan& plan : stages_of(data, "all")) CHECK(stages.insert(plan.name).second);
  CHECK(stages_of(data, "box").size() == 1);
  CHECK(stages_of(data, "fig10").size() == 3);
  CHECK_THROWS_WITH(stages_of(data, "fig2"), Catch::Contains("'fig2'") && Catch::Contains("fig13"));
}

TEST_CASE("what is compared between two groups compares every sample with itself") {
  std::vector<RunRow> rows;
  rows.reserve(20);
  // The second sample has ten times the displacement, which adds no error to the exponent.
  const Groups groups{group_of(5.0, {4.0, 40.0, 7.0}, rows), group_of(10.0, {1.0, 10.0}, rows)};
  const auto exponents = exponents_of_samples(groups, "frequency", "rise", 2);
  REQUIRE(exponents.size() == 2);
  for (const auto& [seed, exponent] : exponents) CHECK(exponent == Approx(-2.0));
  CHECK(exponents_of_samples(groups, "frequency", "rise").empty());
  const SampleMean change = log_change(groups[0], groups[1], "rise");
  CHECK(change.mean == Approx(-std::log(4.0)));
  CHECK(change.samples == 2);
  CHECK(at(groups, 10.0) == &groups[1]);
  CHECK(at(groups, 7.0) == nullptr);
  CHECK(groups[0].mean("rise").mean == Approx(17.0));
}

TEST_CASE("what a packing has in common is in the scatter between samples, not from run to run") {
  std::vector<RunRow> rows;
  rows.reserve(20);
  // Two packings that always differ by a factor e^2; the runs deviate from it by e^0.2.
  const Groups groups{group_of(1.0, {1.0, std::exp(2.2)}, rows),
                      group_of(2.0, {std::exp(5.0), std::exp(6.8)}, rows),
                      group_of(3.0, {std::exp(7.0)}, rows)};
  const PooledError between = scatter_between(groups, "rise"),
                    paired = scatter_paired(groups, "rise");
  CHECK(between.degrees_of_freedom == 2);
  CHECK(between.deviation == Approx(std::sqrt(0.5 * (2.2 * 2.2 / 2.0 + 1.8 * 1.8 / 2.0))));
  CHECK(paired.degrees_of_freedom == 1);
  CHECK(paired.deviation == Approx(0.2));  // differences of 2.2 and 1.8, from four runs
  CHECK(scatter_paired({groups[0]}, "rise").degrees_of_freedom == 0);
}

TEST_CASE("a selection takes rows by stage and by what they say, to six digits") {
  PaperData data({}, "nowhere", [] {
    std::vector<RunRow> rows(4);
    for (RunRow& row : rows) {
      row.key = row.stage = "force";
      row.solver = "pgs";
      row["grains"] = 300.0;
    }
    rows[1].stage = "sizes";
    rows[1].name = "sizes.wide-seed=1";
    rows[2].solver = "sap";
    rows[2]["grains"] = 300.0001;
    rows[3]["grains"] = 600.0;
    return rows;
  }());
  const auto taken = [&](const char* words) { return data.rows(words).size(); };
  CHECK(taken("force") == 3);
  CHECK(taken("force; sizes") == 4);
  CHECK(taken("sizes name~wide; force grains>400") == 2);
  CHECK(taken("sizes name~similar") == 0);
  CHECK(taken("force grains=300") == 2);
  CHECK(taken("force grains!300") == 1);
  CHECK(taken("force grains<400 solver!sap") == 1);
  CHECK(taken("force solver=sap") == 1);
  CHECK_THROWS_AS(taken("force nothing=1"), std::invalid_argument);
}

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
  RunRow was = made_up_row();
  was["seed"] = 5'000'000'001;
  const auto file = folder.path() / "runs.csv";
  write_whole_file(file, runs_csv(std::vector<RunRow>(2, was)));
  CsvReader reader(file);
  std::vector<std::vector<std::string>> lines;
  while (reader.next()) lines.emplace_back(reader.cells().begin(), reader.cells().end());
  REQUIRE(lines.size() == 4);
  CHECK(std::set<std::string>(lines[0].begin(), lines[0].end()).size() == lines[0].size());
  CHECK(lines[0].size() == was.numbers.size() + 5);
  const auto column = [&](const std::string& name) {
    return static_cast<size_t>(std::ranges::find(lines[0], name) - lines[0].begin());
  };
  CHECK(lines[2][0] == "made");
  CHECK(lines[1][column("rise")] == "m");
  CHECK(lines[3][column("roll_top")].empty());  // unknown
  CHECK(lines[3][column("seed")] == "5000000001");

  const std::vector<RunRow> rows = read_runs_csv(file);
  REQUIRE(rows.size() == 2);
  const RunRow& row = rows.back();
  CHECK(row.name + row.stage + row.key + row.solver == "madeforce0123pgs");
  CHECK(row.record == was.record);
  for (size_t k = 0; k < was.numbers.size(); ++k) {
    INFO(lines[0][k + 5]);
    const double before = was.numbers[k], after = row.numbers[k];
    CHECK(std::isfinite(before) == std::isfinite(after));
    if (std::isfinite(before)) CHECK(after == Approx(before).epsilon(1e-8));
  }
  CHECK(row["circulation"] == -0.125);
  CHECK(row["relative_gain"] == row["gain"] / row["density_reference"]);
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
  // A file of an earlier version, with a column that no longer exists.
  CHECK(refusal("name,stage,key,record,solver,layer1\n" + units + "a,b,c,d,e,1\n") == "read");
  CHECK_THAT(refusal(head), Catch::Contains("units"));
  CHECK_THAT(refusal(head + units + "a,b,c,d,e,much\n"),
             Catch::Contains("runs.csv:3") && Catch::Contains("rise") && Catch::Contains("much"));
  CHECK_THAT(refusal(head + units + "a,b,c,d,e\n"), Catch::Contains("runs.csv:3"));
}
