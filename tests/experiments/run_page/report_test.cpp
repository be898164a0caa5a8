#include "experiments/run_page/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "experiments/measure/run_data.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/program.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/run_page/box_run.hpp"
#include "tests/support/environment_guard.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"

namespace ballast {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

nlohmann::ordered_json manifest_of_box() {
  return {{"ballast",
           {{"version", "0.1.0"},
            {"commit", "0123456789abcdef0123"},
            {"modified", true},
            {"libraries", {{"Eigen", "3.4.0"}}}}},
          {"machine", {{"cpu", "a processor"}, {"cores", 2}}},
          {"scene", "vibrated_box"},
          {"overrides", {"drive.frequency=5", "scene.title=it's"}},
          {"started", "2025-01-01T00:00:00Z"},
          {"resumed", nlohmann::ordered_json::array()},
          {"summary", {{"grain_mass_kg", 214.0}, {"solid_fraction_initial", 0.501}}}};
}

std::string page_of(const TemporaryFolder& folder) {
  write_report(folder.path());
  return read_whole_file(folder.path() / "report.html");
}

void write_scene(const TemporaryFolder& folder, const std::string& name) {
  folder.write("scene.toml", resolve_scene(find_scene(name)).text);
}

void write_box(const TemporaryFolder& folder, const std::vector<std::string>& without = {}) {
  write_rows(folder.path(), synthetic_box(), without);
  folder.write("manifest.json", manifest_of_box().dump());
  write_scene(folder, "vibrated_box");
}

/// Writes a slide of a scene without a wall.
void write_slide(const TemporaryFolder& folder, const std::vector<std::string>& without = {}) {
  write_rows(folder.path(), synthetic_slide(), without);
  folder.write("manifest.json", "{}");
  write_scene(folder, "sliding_cube");
}

TEST_CASE("the box's page has every figure, opens offline and is well-formed") {
  const TemporaryFolder folder;
  write_box(folder);
  const std::string page = page_of(folder);
  for (const char* name :
       {"fig03", "fig04", "fig12", "jammed", "error", "penetration", "effort", "energy"}) {
    CHECK_THAT(page, Contains("<figure id=\"" + std::string(name) + "\">"));
    CHECK(fs::exists(folder.path() / "figures" / (std::string(name) + ".svg")));
    CHECK(fs::exists(folder.path() / "figures" / (std::string(name) + ".gnuplot")));
  }
  check_page(without_scripts(page));
  CHECK(ids_in(page).size() > 20);
  for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
    CHECK(entry.path().extension() != ".tmp");
}

TEST_CASE("the box's page says the numbers beside what is asked and what the paper has") {
  const TemporaryFolder folder;
  write_box(folder);
  const std::string page = page_of(folder);
  CHECK_THAT(page, Contains("6.00\u202fmm") || Contains("6.05\u202fmm"));  // first contraction
  CHECK_THAT(page, Contains(">0.5010<") && Contains(">0.50<") && Contains(">0.5190<") &&
                       Contains(">0.52<"));
  CHECK_THAT(page, Contains("✓ met") && Contains("≤\u00a0250\u202fµm") && Contains("≤\u00a00.001"));
  CHECK_THAT(page, Contains("3 of 3 periods"));
  for (const char* next : {"paper fig12", "compare --live", "run vibrated_box --set"})
    CHECK_THAT(page.substr(page.find("What next")), Contains(next));
  CHECK_THAT(page, Contains("# the program of commit 0123456789abcdef0123"));
  CHECK_THAT(page, Contains("Eigen 3.4.0") && Contains("a processor") &&
                       Contains("commit 0123456789ab, modified"));
}

TEST_CASE("names from files are escaped") {
  const TemporaryFolder folder;
  write_slide(folder);
  auto manifest = manifest_of_box();
  const std::string hostile = "<script>alert('x')</script>\"&";
  manifest["scene"] = hostile;
  manifest["overrides"] = {hostile};
  manifest["machine"]["cpu"] = hostile;
  manifest["ballast"]["commit"] = hostile;
  manifest["summary"][hostile] = hostile;
  manifest["resumed"] = {{{"step", 3}, {"at", hostile}}};
  manifest["started"] = hostile;
  folder.write("manifest.json", manifest.dump());
  const std::string page = page_of(folder);
  CHECK_THAT(page, !Contains("<script>alert") && !Contains("alert('"));
  CHECK_THAT(page, Contains("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot;&amp;"));
  CHECK(nesting_fault(page) == "");
}

TEST_CASE("a sliding cube has no wall and no packing on its page") {
  const TemporaryFolder folder;
  write_slide(folder);
  const std::string page = page_of(folder);
  for (const char* name : {"error", "effort", "energy"})
    CHECK_THAT(page, Contains("<figure id=\"" + std::string(name) + "\">"));
  for (const char* name : {"fig03", "fig04", "fig12", "jammed"})
    CHECK_THAT(page, !Contains("<figure id=\"" + std::string(name) + "\">"));
  CHECK_THAT(page,
             !Contains("Solid fraction") && !Contains("Motion of the wall") && !Contains("Jammed"));
  CHECK(nesting_fault(page) == "");
  // A record with nothing but the time still has a page.
  std::vector<std::string> others;
  for (const StepColumn& column : step_columns().subspan(1)) others.push_back(column.name);
  write_slide(folder, others);
  const std::string bare = page_of(folder);
  CHECK_THAT(bare, Contains("wall_v is not finite in 800 of 800 steps"));
  CHECK(nesting_fault(bare) == "");
}

TEST_CASE("every column but time may be missing, one by one") {
  for (const StepColumn& column : step_columns()) {
    if (std::string(column.name) == "time") continue;
    const TemporaryFolder folder, empty;
    write_box(folder, {column.name});
    const EnvironmentGuard guard(
        "PATH", empty.path().string());  // numbers only: without figures it is 26 times faster
    INFO(column.name);
    const std::string page = page_of(folder);
    CHECK_THAT(page, Contains(std::string(column.name) + " is not finite in 5000 of 5000"));
    CHECK(nesting_fault(page) == "");
    CHECK_THAT(page, !Contains(">nan") && !Contains(">inf"));
  }
}

TEST_CASE("figures that lack their column are named, the others are drawn") {
  const TemporaryFolder folder;
  write_box(folder, {"wall_force", "penetration_max", "penetration_mean", "error_rms", "error_max",
                     "iterations", "kinetic_energy"});
  const std::string page = page_of(folder);
  CHECK_THAT(page, Contains("<figure id=\"fig03\">") && Contains("<figure id=\"fig12\">"));
  CHECK_THAT(page, Contains("figure fig04: nothing to draw") && !Contains("<figure id=\"fig04\">"));
  CHECK_FALSE(fs::exists(folder.path() / "figures" / "fig04.svg"));
}

TEST_CASE("NaN, infinity and one single step") {
  const TemporaryFolder folder;
  auto steps = synthetic_box();
  steps[100].error_rms = NAN;
  steps[2000].wall_force = INFINITY;
  steps[3000].solid_fraction = NAN;
  write_box(folder);
  write_rows(folder.path(), steps);
  const std::string page = page_of(folder);
  CHECK_THAT(page, Contains("error_rms is not finite in 1 of 5000 steps, first in row 101"));
  CHECK_THAT(page, Contains("wall_force is not finite in 1 of 5000 steps, first in row 2001"));
  CHECK_THAT(page, Contains("<figure id=\"fig04\">"));
  steps.resize(1);
  steps[0] = synthetic_box()[0];
  write_rows(folder.path(), steps);
  CHECK(nesting_fault(page_of(folder)) == "");
}

TEST_CASE("the page of a run that is not finished says so") {
  const TemporaryFolder folder;
  write_box(folder);
  auto steps = synthetic_box();
  steps.resize(4000);
  write_rows(folder.path(), steps);
  CHECK_THAT(page_of(folder), Contains("not finished: 4000 of 5000 steps"));
}

TEST_CASE("no record, no report: the error names the file and the place") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_report(folder.path()), Error);
  CHECK_THROWS_WITH(write_report(folder.path() / "nowhere"), Contains("nowhere: no such folder"));
  write_rows(folder.path(), {});
  CHECK_THROWS_WITH(write_report(folder.path()), Contains("holds no step"));
  std::vector<StepRecord> steps(2);
  write_rows(folder.path(), steps);
  CHECK_THROWS_WITH(write_report(folder.path()), Contains("finite and growing in row 2"));
  steps[0].time = not_known;
  write_rows(folder.path(), steps);
  CHECK_THROWS_WITH(write_report(folder.path()), Contains("finite and growing in row 1"));
  CHECK_FALSE(fs::exists(folder.path() / "report.html"));
}

TEST_CASE("neither a manifest of other parts nor a scene that is wrong is a fault of the page") {
  const TemporaryFolder folder;
  write_slide(folder);
  folder.write("manifest.json",
               GENERATE("{\"summary\": 3, \"ballast\": [], \"overrides\": {}, \"resumed\": 1}",
                        "{\"summary\": {\"deep\": {\"er\": [1, {\"a\": null}]}}}"));
  CHECK(nesting_fault(page_of(folder)) == "");
  write_box(folder);  // a scene whose meshes are gone still has a page
  folder.write("scene.toml", "[scene]\nname = 3\n");
  const std::string page = page_of(folder);
  CHECK_THAT(page, Contains("The scene cannot be used: ") && !Contains(">nan"));
  CHECK(nesting_fault(page) == "");
}

TEST_CASE("the scene's parameters are on the page") {
  const TemporaryFolder folder;
  write_box(folder);
  const std::string page = page_of(folder);
  CHECK_THAT(page, Contains("<h1>The paper&#39;s vibrated box") && Contains("density = 2700") &&
                       Contains("The whole scene (scene.toml)"));
  CHECK_THAT(page, !Contains("To be known before reading"));
}

/// The plain words of the row whose first cell begins with `beginning`.
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
  RunSummary floating = summarise(data.steps, data.facts);
  row_of(results_table(floating), "error, rms over contacts (g h)");
  floating.facts.velocity_scale = 1.0;  // without gravity
  row_of(results_table(floating), "error, rms over contacts (m/s)");
  // A scene without limits is not judged.
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

TEST_CASE("a row for each whole period, its number counted from the drive's start") {
  RunSummary summary = box_run().summary;
  const page::Table table = periods_table(summary);
  REQUIRE(table.rows.size() == summary.wall.periods.size());
  REQUIRE(table.rows.size() > 2);
  for (size_t p = 0; p < table.rows.size(); ++p) {
    CHECK(table.rows[p].size() == table.head.size());
    CHECK(table.rows[p][0] == page::exact(std::round(5.0 * summary.wall.periods[p].end)));
  }
  CHECK(plain_words(table.rows[0].back()) == "–");  // the first period has no gain
  CHECK(plain_words(table.rows[1].back()) == "0.0012");
  summary.facts.has_packing = false;  // takes the column of the solid fraction out
  const page::Table bare = periods_table(summary);
  CHECK((bare.head.size() == 8 && bare.rows[0].size() == 8 && bare.is_number.size() == 8));
}

TEST_CASE("what makes a run again and what comes next can be pasted in any folder") {
  RunData data;
  data.folder = "some folder/run";
  data.scene_text = "[scene]\n";
  const std::string folder = std::filesystem::absolute(data.folder).string();
  CHECK_THAT(reproduce_commands(data),
             Catch::Contains(shell_line({executable_path().string(), "run", folder + "/scene.toml",
                                         "--output", folder + "-again"})));
  data.scene_text.clear();  // leaves nothing to run again
  CHECK_THAT(reproduce_commands(data), !Catch::Contains("run"));
  for (const bool has_grains : {false, true})
    CHECK_THAT(next_commands(has_grains),
               Catch::Contains(shell_quoted(executable_path().string())));
}

}  // namespace
}  // namespace ballast
