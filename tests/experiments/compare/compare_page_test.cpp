// The page of a comparison is well-formed, with its figures beside it, and has the data for its
// answers: the CSV's cells, histories that fit into a page, a command for every row.

#include "experiments/compare/compare_page.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Json = nlohmann::json;

TEST_CASE("The page of a comparison is well-formed and has what it promises") {
  const TemporaryFolder folder;
  std::vector<CompareRow> rows;
  for (const char* name : {"x1", "y2"}) {
    rows.push_back(hand_made_row(name, "a", 0.1, Verdict::solved));
    rows.push_back(hand_made_row(name, "b", 0.3, Verdict::solved));
    rows.push_back(hand_made_row(name, "c", 60.0, Verdict::timeout));
    rows.back().reason = "time_limit";
  }
  rows.push_back(hand_made_row("z&<1", "a", 0.2, Verdict::denied));
  Manifest("compare", {"ballast compare <x>"}, "key").write(folder.path() / "manifest.json");
  write_compare_page(folder.path(), rows);
  const std::string page = read_whole_file(folder.path() / "compare.html");
  check_page(without_scripts(page));
  CHECK(page.find("z&amp;&lt;1") != std::string::npos);
  CHECK(page.find("the judge denies it") != std::string::npos);
  CHECK(page.find("unsolved in it") != std::string::npos);  // cases that the mean hides
  // Where the page can answer, it has a place for each figure that it draws itself.
  for (const char* id : {"matrix", "profiles", "case-figures"})
    CHECK((page.find(std::string("id=\"") + id + "\"") != std::string::npos) ==
          page::has_chart_library());
}

TEST_CASE("What must not happen is told once, and what could not be read among it") {
  const TemporaryFolder folder;
  std::vector<CompareRow> rows = {hand_made_row("x", "a", 0.1, Verdict::solved)};
  for (const char* name : {"x", "y"}) {
    rows.push_back(hand_made_row(name, "b", 0.1, Verdict::unsupported));
    rows.back().note = "takes no dynamics";
  }
  rows.push_back(hand_made_row("broken.dat", "", 0.0, Verdict::unreadable));
  rows.back().note = "line 3: no number";
  rows.push_back(hand_made_row("y", "a", 0.1, Verdict::timeout));  // has no note: not listed
  Manifest("compare", {"ballast compare"}, "key").write(folder.path() / "manifest.json");
  write_compare_page(folder.path(), rows);
  const std::string page = without_scripts(read_whole_file(folder.path() / "compare.html")),
                    section = page.substr(page.find("id=\"failures\"")),
                    failures = section.substr(0, section.find("</section>"));
  CHECK_THAT(failures, Catch::Contains("unsupported: takes no dynamics") &&
                           Catch::Contains("unreadable: line 3: no number") &&
                           !Catch::Contains("timeout"));
  CHECK(failures.find("takes no dynamics") == failures.rfind("takes no dynamics"));
}

TEST_CASE("The terminal hears of every backend") {
  const std::vector<CompareRow> rows = {hand_made_row("x.dat", "a", 2.0, Verdict::solved),
                                        hand_made_row("x.dat", "b", 4.0, Verdict::denied)};
  const std::string said = compare_summary(rows);
  CHECK_THAT(said, Catch::Contains("Tolerance 0.0001, cold start, 1 cases") &&
                       Catch::Contains("  a ") && Catch::Contains("CLAIMS DENIED"));
}

TEST_CASE("The page's data are the cells of the CSV, to the letter") {
  std::vector<CompareRow> rows = {hand_made_row("x, \"1\"", "a", 0.1, Verdict::solved),
                                  hand_made_row("y", "b", 60.0, Verdict::timeout)};
  rows[0].word = "my problems/x.dat";
  rows[0].prepare_seconds = 0.25;
  rows[0].history.insert(rows[0].history.begin() + 2, {1, 0.06, 0.1});  // a worse error: left out
  RunData run;
  run.stored_manifest = std::make_shared<const nlohmann::ordered_json>(
      nlohmann::ordered_json{{"summary", {{"memory_MB", 512.0}}}});
  const page::Answers answers = comparison_answers(run, rows);
  CHECK(answers.is_enabled);
  const Json data = Json::parse(answers.data);
  REQUIRE(data["columns"].size() == compare_columns().size());
  for (size_t c = 0; c < compare_columns().size(); ++c) {
    const std::string first = cells_of(rows[0])[c], second = cells_of(rows[1])[c];
    CHECK(data["columns"][compare_columns()[c]] == first + '\n' + second + '\n');
  }
  CHECK(data["limit"] == 60.0);
  // A shell reads the word as one. A case without a word has its name.
  CHECK(data["more"]["word"] == "'my problems/x.dat'\ny\n");
  CHECK_THAT(data["again"].get<std::string>(),
             Catch::Contains("--measure natural_map --max-seconds 60 --memory 512 --output"));
  // By turns: seconds, with those of prepare, and the least error so far.
  const std::string history = "0.25 1 0.3 0.01 0.35 5e-05\n";
  CHECK(data["more"]["history"].get<std::string>().substr(0, history.size()) == history);
}

TEST_CASE("Long histories are thinned out to what a page can hold") {
  CompareRow row = hand_made_row("x", "a", 1.0, Verdict::solved);
  row.history.clear();
  for (int k = 0; k < 5000; ++k) row.history.push_back({k, 1e-4 * k, 1.0 / (1.0 + k)});
  const std::vector<CompareRow> rows(3000, row);
  const Json data = Json::parse(comparison_answers({}, rows).data);
  const std::string histories = data["more"]["history"];
  const std::string first = histories.substr(0, histories.find('\n'));
  const long points = (1 + std::ranges::count(first, ' ')) / 2;
  CHECK(points >= 8);
  CHECK(points <= 40);
  CHECK_THAT(first, Catch::EndsWith(" 0.0002"));  // the last error is kept
}

TEST_CASE("Times are medians over repeats, and solved is what every repeat solves") {
  const std::vector<CompareRow> rows = {hand_made_row("x", "a", 3.0, Verdict::solved, 0),
                                        hand_made_row("x", "a", 1.0, Verdict::solved, 1),
                                        hand_made_row("x", "a", 2.0, Verdict::solved, 2),
                                        hand_made_row("x", "b", 1.0, Verdict::solved, 0),
                                        hand_made_row("x", "b", 60.0, Verdict::timeout, 1),
                                        hand_made_row("broken", "", 0.0, Verdict::unreadable)};
  const std::vector<CompareTable> tables = compare_tables(rows);
  REQUIRE(tables.size() == 1);
  CHECK(tables[0].heading == "Tolerance 0.0001, cold start");
  CHECK(tables[0].cases.size() == 1);
  REQUIRE(tables[0].backends.size() == 2);
  const BackendSummary &a = tables[0].backends[0], &b = tables[0].backends[1];
  CHECK(a.solver == "a");
  CHECK(a.solved == 1);
  CHECK(a.mean_seconds == Approx(2.0));
  CHECK(a.mean_ratio == Approx(1.0));
  CHECK(a.largest_spread == 1.0);
  CHECK(b.solved == 0);
  CHECK(b.mean_seconds == Approx(60.0));  // the limit counts
}

TEST_CASE("Tables come from the loosest tolerance, and a case counts where it was tried") {
  std::vector<CompareRow> rows = {hand_made_row("x", "a", 1.0, Verdict::solved),
                                  hand_made_row("y", "a", 1.0, Verdict::timeout),
                                  hand_made_row("y", "a", 1.0, Verdict::solved)};
  rows[0].tolerance = 1e-2;
  rows[2].start = StartKind::warm;
  const std::vector<CompareTable> tables = compare_tables(rows);
  REQUIRE(tables.size() == 3);
  CHECK(tables[0].heading == "Tolerance 0.01, cold start");
  CHECK(tables[1].heading == "Tolerance 0.0001, cold start");
  CHECK(tables[2].heading == "Tolerance 0.0001, warm start");
  CHECK(std::isnan(tables[1].backends.at(0).mean_ratio));  // no backend solved anything
}

TEST_CASE("Who solves most comes first, and what was not solved counts with the limit") {
  std::vector<CompareRow> rows = {
      hand_made_row("x", "a", 1.0, Verdict::solved),
      hand_made_row("y", "a", 60.0, Verdict::timeout),
      hand_made_row("x", "b", 2.0, Verdict::solved),
      hand_made_row("y", "b", 8.0, Verdict::solved),
      hand_made_row("x", "c", 0.0, Verdict::crashed),
      hand_made_row("y", "c", 0.5, Verdict::denied),
      hand_made_row("z", "c", 0.5, Verdict::no_solution),
  };
  CHECK(limit_of(rows) == 60.0);
  const std::vector<BackendSummary> all = compare_tables(rows).at(0).backends;
  REQUIRE(all.size() == 3);
  CHECK(all[0].solver == "b");
  CHECK(all[0].solved == 2);
  CHECK(all[0].mean_seconds == Approx(std::sqrt(2.001 * 8.001) - 0.001));
  CHECK(all[0].mean_ratio == Approx(std::sqrt(2.001 / 1.001)));
  CHECK(all[1].solver == "a");
  CHECK(all[0].unsolved == 0);
  CHECK(all[1].timeouts == 1);
  CHECK(all[1].unsolved == 1);  // counts in the mean with the limit
  CHECK(all[1].mean_seconds == Approx(std::sqrt(1.001 * 60.001) - 0.001));
  CHECK(all[2].solver == "c");
  CHECK(all[2].crashes == 1);
  CHECK(all[2].denied == 1);
  CHECK(all[2].solved == 0);
  CHECK(all[2].unsolved == 3);
  CHECK(all[2].no_solutions == 1);
}
