// The page of a closed loop: well-formed, with its files beside it.

#include "experiments/compare/live_page.hpp"

#include <algorithm>

#include "experiments/page/plot.hpp"
#include "experiments/run/manifest.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/compare/hand_made_live.hpp"
#include "tests/support/page_sample.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("The page of a closed loop says who was the reference, and what others' words were") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_live_page(folder.path(), hand_made_live()), Error);  // no manifest
  Manifest("compare --live x", {}, "key").write(folder.path() / "manifest.json");
  write_live_page(folder.path(), hand_made_live());
  const std::string page = read_whole_file(folder.path() / "live.html");
  check_page(without_scripts(page));
  CHECK(page.find("(reference)") != std::string::npos);
  CHECK(page.find("hand &amp; made") != std::string::npos);
  CHECK(page.find("failed: &lt;no words&gt;") != std::string::npos);
  const std::string csv = read_whole_file(folder.path() / "live.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 4);
  CHECK(std::filesystem::exists(folder.path() / "steps-pgs_0_1.csv"));
  if (!gnuplot_version().empty())
    CHECK(page.find("<figure id=\"live_distance\"") != std::string::npos);
}
