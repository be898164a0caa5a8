#include "experiments/compare/comparison_site.hpp"

#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/csv.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_row.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("A site has a page for all, a comparison for each machine, and every row") {
  const TemporaryFolder folder;
  std::vector<StoredComparison> comparisons;
  for (const char* machine : {"One CPU, 2 cores", "Other <CPU>"}) {
    CompareRow row = hand_made_row("x", "pgs", 1.0, Verdict::solved);
    row.facts.content = "0123";
    row.key = std::string("key") + machine[0];
    const fs::path own = folder.path() / row.key;
    create_folder(own);
    Manifest("compare", {}, "key").write(own / "manifest.json");
    comparisons.push_back({own, machine, "commit", "2026-01-02T00:00:00Z", {row}});
  }
  const fs::path site = folder.path() / "site";
  write_comparison_site(site, comparisons, "ballast compare merge");
  const std::string page = read_whole_file(site / "index.html");
  CHECK_THAT(page, Catch::Contains("Other &lt;CPU>") || Catch::Contains("Other &lt;CPU&gt;"));
  CHECK_THAT(page, Catch::Contains("machines/M1-One-CPU-2-cores/compare.html"));
  CHECK_THAT(page, Catch::Contains("Machines: 2; comparisons: 2"));
  CHECK(fs::exists(site / "machines/M2-Other-CPU/compare.html"));
  // A machine's folder is a comparison: it can be merged again.
  const StoredComparison again = read_comparison(site / "machines/M1-One-CPU-2-cores");
  REQUIRE(again.rows.size() == 1);
  CHECK(again.rows[0].key == "keyO");
  const std::string rows = read_whole_file(site / "rows.csv");
  CHECK(std::count(rows.begin(), rows.end(), '\n') == 3);
  CHECK_THAT(rows, Catch::StartsWith("machine,program,started,case,"));
  // Written again over itself, with less.
  comparisons.pop_back();
  write_comparison_site(site, comparisons, "ballast compare merge");
  CHECK_THAT(read_whole_file(site / "index.html"), Catch::Contains("Machines: 1; comparisons: 1"));
}
