#include "experiments/compare/ranking.hpp"

#include <cmath>
#include <map>
#include <numeric>

#include "experiments/compare/collection.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "platform/random.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

/// A case of run `run` on which the backends a, b, ... take these seconds; 0: not solved.
void add_case(std::vector<CompareRow>& rows, const std::string& name,
              const std::vector<double>& seconds) {
  for (size_t s = 0; s < seconds.size(); ++s) {
    const std::string solver(1, static_cast<char>('a' + s));
    rows.push_back(hand_made_row(name.c_str(), solver.c_str(), std::max(seconds[s], 1.0),
                                 seconds[s] > 0.0 ? Verdict::solved : Verdict::unsolved));
  }
}

std::vector<Eigen::Index> all_of(const TriedCases& tried) {
  std::vector<Eigen::Index> all(tried.cases.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Two families, each of ten open and five held problems. The fast backend crashes in the second.
std::vector<CompareRow> two_families() {
  std::vector<CompareRow> rows;
  for (const std::string family : {"steady", "<wild>"}) {
    int open = 0, held = 0;
    for (int k = 0; open < 10 || held < 5; ++k) {
      const std::string content = family + std::to_string(k);
      if (is_held(content) ? held++ >= 5 : open++ >= 10) continue;
      for (const auto& [solver, seconds] : {std::pair("fast", 0.1), {"sure", 1.0}}) {
        const bool crashes = family == "<wild>" && std::string(solver) == "fast";
        rows.push_back(hand_made_row(("x" + content).c_str(), solver, seconds,
                                     crashes ? Verdict::crashed : Verdict::solved));
        rows.back().family = family + ", active";
        rows.back().facts.content = content;
      }
    }
  }
  rows.push_back(hand_made_row("broken", "", 0.0, Verdict::unreadable));
  return rows;
}

}  // namespace

TEST_CASE("Cases that every backend tried are compared, unsolved ones with the limit") {
  std::vector<CompareRow> rows;
  add_case(rows, "x", {1.0, 2.0});
  add_case(rows, "y", {0.0, 2.0});
  add_case(rows, "z", {1.0});                                        // b did not try it
  rows.push_back(hand_made_row("x", "a", 3.0, Verdict::solved, 1));  // its median becomes 2
  rows.push_back(hand_made_row("w", "", 0.0, Verdict::unreadable));
  rows.push_back(hand_made_row("x", "a", 1.0, Verdict::solved));
  rows.back().tolerance = 1e-8;
  const std::vector<TriedCases> tried = tried_cases(rows);
  REQUIRE(tried.size() == 2);
  CHECK(tried[0].tolerance == 1e-4);
  CHECK(tried[1].solvers == std::vector<std::string>{"a"});
  REQUIRE(tried[0].cases.size() == 2);
  CHECK(tried[0].cases[1]->case_name == "y");
  CHECK(tried[0].log_seconds(0, 0) == Approx(std::log(2.0 + summary_shift)));
  CHECK(tried[0].log_seconds(1, 0) == Approx(std::log(60.0 + summary_shift)));
}

TEST_CASE("Ranks are by mean time, and their range is where they are sure") {
  std::vector<CompareRow> rows;
  Random random(7);
  // a is ten times faster than b and c, which differ from run to run; d and e never solve.
  for (int run = 0; run < 12; ++run)
    for (int step = 0; step < 3; ++step)
      add_case(rows, "run" + std::to_string(run) + "-step_" + std::to_string(step),
               {0.1, run % 2 ? 1.5 : 2.5, run % 2 ? 2.5 : 1.5, 0.0, 0.0});
  const std::vector<TriedCases> tried = tried_cases(rows);
  const std::vector<Estimate> ranks = ranks_of(tried[0], all_of(tried[0]));
  REQUIRE(ranks.size() == 5);
  CHECK(ranks[0].value == 1.0);
  CHECK(ranks[0].high == 1.0);
  CHECK(ranks[1].low == 2.0);
  CHECK(ranks[1].high == 3.0);
  CHECK(ranks[3].value == 4.5);
  CHECK(ranks[4].low == 4.5);
  // The draws are the same every time. With too few runs there is no range.
  CHECK(ranks_of(tried[0], all_of(tried[0]))[2].low == ranks[2].low);
  std::vector<Eigen::Index> few = all_of(tried[0]);
  few.resize(4);  // two runs
  CHECK(ranks_of(tried[0], few)[0].value == 1.0);
  CHECK(std::isnan(ranks_of(tried[0], few)[0].low));
  CHECK(std::isnan(ranks_of(tried[0], {})[0].value));
}

TEST_CASE("Cases of a run are alike, and a phase is no family") {
  CHECK(run_of("shaken/25-1-step_0000050") == "shaken/25-1-");
  CHECK(run_of("pile-c10-s1.hdf5") == "pile-c10-s1.hdf5");
  CompareRow row;
  row.family = "shaken, active";
  CHECK(base_family(row) == "shaken");
}

TEST_CASE("A ranking is a page and a table, with the held part apart") {
  const TemporaryFolder folder;
  Manifest("compare", {"ballast compare ranking"}, "").write(folder.path() / "manifest.json");
  const std::vector<CompareRow> rows = two_families();
  write_ranking(folder.path(), rows);
  // A line for each part, family and backend.
  std::map<std::string, std::vector<std::string>> lines;
  CsvReader table(folder.path() / "table.csv");
  while (table.next()) {
    const auto cells = table.cells();
    lines[cells[0] + ' ' + cells[1] + ' ' + cells[4]] = {cells.begin(), cells.end()};
  }
  CHECK(lines.size() == 1 + 2 * 4 * 2);
  CHECK(lines.at("open all fast")[6] == "20");
  CHECK(lines.at("open all fast")[7] == "10");
  CHECK(lines.at("open all fast")[8] == "0.5");
  CHECK(lines.at("open <wild> fast")[12] == "10");  // crashes
  CHECK(lines.at("held all sure")[6] == "10");
  CHECK(lines.at("held steady fast")[9] == "0.1");     // mean time
  CHECK(lines.at("held steady sure")[10] == "9.911");  // (1 + 1 ms) / (0.1 + 1 ms)
  const std::string page = read_whole_file(folder.path() / "index.html");
  check_page(without_scripts(page));
  for (const char* words : {"2 backends on 30 problems.", "&lt;wild&gt;", "10 crashed",
                            "&lt;wild&gt; (10 of 10)", "held: solved", "1 to 10 contacts"})
    CHECK_THAT(page, Catch::Contains(words));
  CHECK_THAT(read_whole_file(folder.path() / "ranking.md"),
             Catch::Contains("2 backends on 30 problems.") && Catch::Contains("| sure |"));
  // Writing the ranking again gives the same bytes.
  const std::string again = read_whole_file(folder.path() / "table.csv");
  write_ranking(folder.path(), rows);
  CHECK(read_whole_file(folder.path() / "table.csv") == again);
  CHECK(read_whole_file(folder.path() / "index.html") == page);
}

TEST_CASE("A ranking of one backend on one problem is none, and says so with dashes") {
  const TemporaryFolder folder;
  Manifest("compare", {"ballast compare ranking"}, "").write(folder.path() / "manifest.json");
  const std::vector<CompareRow> rows = {hand_made_row("x", "a", 0.1, Verdict::solved)};
  write_ranking(folder.path(), rows);
  check_page(without_scripts(read_whole_file(folder.path() / "index.html")));
}
