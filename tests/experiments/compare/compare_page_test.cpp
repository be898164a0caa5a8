// The page of a comparison: well-formed, with its figures beside it.

#include "experiments/compare/compare_page.hpp"

#include "experiments/page/html.hpp"
#include "experiments/page/plot.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("The page of a comparison is well-formed and has what it promises") {
  const TemporaryFolder folder;
  std::vector<CompareRow> rows;
  for (const char* name : {"x&<1", "y2"}) {
    rows.push_back(hand_made_row(name, "a", 0.1, Verdict::solved));
    rows.push_back(hand_made_row(name, "b", 0.3, Verdict::solved));
    rows.push_back(hand_made_row(name, "c", 60.0, Verdict::timeout));
    rows.back().reason = "time_limit";
  }
  rows.push_back(hand_made_row("z", "a", 0.2, Verdict::denied));
  Manifest("compare", {"ballast compare <x>"}, "key").write(folder.path() / "manifest.json");
  write_compare_page(folder.path(), rows, {});
  const std::string page = read_whole_file(folder.path() / "compare.html");
  check_page(without_scripts(page));
  CHECK(page.find("x&amp;&lt;1") != std::string::npos);
  CHECK(page.find("the judge denies it") != std::string::npos);
  // Every case by every backend: a time, or the reason and the error; and what a mean hides.
  CHECK(page.find("Every case by every backend") != std::string::npos);
  CHECK(page.find("time limit") != std::string::npos);
  CHECK(page.find("denied") != std::string::npos);
  CHECK(page.find("unsolved in it") != std::string::npos);
  // A page that answers draws all but profiles by itself, and only links to their files.
  if (!gnuplot_version().empty())
    for (const std::string name :
         {"performance_cold_1e-04", "data_cold_1e-04", "cost_contacts_cold_1e-04", "case_y2_cold",
          "family_hand_cold"}) {
      INFO(name);
      const bool is_profile = name[0] == 'p' || name[0] == 'd';
      const bool is_linked = page.find("figures/" + name + ".svg\">") != std::string::npos;
      CHECK(is_linked == (page::can_answer() && !is_profile));
      CHECK((page.find("<figure id=\"" + name) != std::string::npos) == !is_linked);
      CHECK(std::filesystem::file_size(folder.path() / "figures" / (name + ".pdf")) > 1000);
    }
}
