#include "experiments/run_page/report_tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/experiments/run_page/box_run.hpp"

namespace ballast {
namespace {

using Catch::Matchers::Contains;

/// The row whose first cell begins so, as plain words.
std::vector<std::string> row_of(const page::Table& table, const std::string& beginning) {
  for (const auto& row : table.rows) {
    if (!plain_words(row[0]).starts_with(beginning)) continue;
    std::vector<std::string> words;
    for (const page::Text& cell : row) words.push_back(plain_words(cell));
    return words;
  }
  FAIL("no row begins with " + beginning);
  return {};
}

TEST_CASE("numbers stand beside their bounds, in the same unit, with a verdict") {
  RunSummary summary = box_run().summary;
  summary.penetration_max = 300e-6;
  summary.penetration_mean = 2.5e-6;
  const page::Table table = results_table(summary);
  CHECK(row_of(table, "deepest of all steps") ==
        std::vector<std::string>{"deepest of all steps", "300\u202fµm", "≤\u00a0250\u202fµm",
                                 "✗ missed"});
  CHECK(row_of(table, "mean over active contact points")[3] == "✓ met");
  CHECK(row_of(table, "before the drive") ==
        std::vector<std::string>{"before the drive", "0.5010", "0.50", "paper"});
  for (const auto& row : table.rows) CHECK(row.size() == table.head.size());
}

TEST_CASE("errors are judged by what the scene asks of each step") {
  const RunData data = box_run().data;
  const auto rows = [&](double tolerance) {
    RunFacts facts = data.facts;
    facts.tolerance = tolerance;
    RunSummary summary = summarise(data.steps, facts);
    summary.error_mean_relative = 0.009;
    summary.error_max_relative = 0.08;
    const page::Table table = results_table(summary);
    return std::array{row_of(table, "error, rms"), row_of(table, "the same: worst step")};
  };
  const auto [mean, worst] = rows(0.01);
  CHECK(mean[2] == "≤\u00a00.01");
  CHECK(mean[3] == "✓ met");
  CHECK(worst[2] == "≤\u00a00.01");
  CHECK(worst[3] == "✗ missed");
  CHECK(rows(0.001)[0][3] == "✗ missed");
  // a scene that asks for nothing is not judged
  CHECK(rows(not_known)[0][2].empty());
  CHECK(rows(not_known)[0][3].empty());
}

TEST_CASE("what is not known takes no row, and a group without rows no heading") {
  RunSummary summary = box_run().summary;
  const auto has_row = [&](const std::string& beginning) {
    const page::Table table = results_table(summary);
    return std::any_of(table.rows.begin(), table.rows.end(),
                       [&](const auto& row) { return plain_words(row[0]).starts_with(beginning); });
  };
  CHECK(has_row("deepest of all steps"));
  summary.penetration_max = not_known;
  CHECK_FALSE(has_row("deepest of all steps"));
  CHECK(has_row("Overlap"));
  summary.penetration_mean = not_known;
  CHECK_FALSE(has_row("Overlap"));
}

TEST_CASE("without a wall and a packing nothing is said of them") {
  const page::Table table = results_table(slide_run().summary);
  for (const auto& row : table.rows)
    CHECK_THAT(plain_words(row[0]), !Contains("Jammed") && !Contains("Solid fraction"));
  CHECK(periods_table(slide_run().summary).rows.empty());
}

TEST_CASE("a row for each whole period, its number counted from the drive's start") {
  const RunSummary summary = box_run().summary;
  const page::Table table = periods_table(summary);
  REQUIRE(table.rows.size() == summary.wall.periods.size());
  REQUIRE(table.rows.size() > 2);
  for (size_t p = 0; p < table.rows.size(); ++p) {
    CHECK(table.rows[p].size() == table.head.size());
    CHECK(table.rows[p][0] == page::exact(std::round(5.0 * summary.wall.periods[p].end)));
  }
  CHECK(plain_words(table.rows[0].back()) == "–");  // no gain before the first
  CHECK(plain_words(table.rows[1].back()) == "0.0012");
}

TEST_CASE("phases add up to all") {
  RunSummary summary = slide_run().summary;
  const page::Table table = cost_table(summary);
  REQUIRE(table.rows.size() == summary.cost.size() + 1);
  double sum = 0.0;
  for (const PhaseCost& phase : summary.cost) sum += phase.ms_per_step;
  CHECK(table.rows.back()[1] == page::number(sum));
  CHECK(plain_words(table.rows.back()[2]) == "100");
}

TEST_CASE("every energy has its own row") {
  RunSummary summary = slide_run().summary;
  summary.energy.work_load = 1.0;
  summary.energy.work_gravity = 2.0;
  summary.energy.dissipated = 3.0;
  const page::Table table = energy_table(summary);
  CHECK(row_of(table, "work of the load")[1] == "1.000");
  CHECK(row_of(table, "work of gravity")[1] == "2.000");
  CHECK(row_of(table, "dissipated")[1] == "3.000");
}

}  // namespace
}  // namespace ballast
