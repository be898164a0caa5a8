#include <map>

#include "experiments/compare/collection.hpp"
#include "experiments/compare/ranking.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

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
