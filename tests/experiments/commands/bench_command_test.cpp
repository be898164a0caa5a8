// The command `ballast bench`: two results side by side, and a short measurement.

#include <filesystem>
#include <sstream>

#include "experiments/bench/measurement.hpp"
#include "experiments/compare/compare_row.hpp"
#include "platform/atomic_file.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

TEST_CASE("two results are printed as a ratio table") {
  const TemporaryFolder folder;
  for (const auto& [name, value] : {std::pair("a", 10.0), std::pair("b", 5.0)})
    write_bench_result(folder.path() / name, "step", "ballast bench step",
                       {measurement_of("1 thread, all", "step", "ms", {value})});
  const std::string a = (folder.path() / "a" / "step.json").string(),
                    b = (folder.path() / "b" / "step.json").string();
  const ProgramResult result = ballast_program({"bench", "diff", a, b});
  CHECK(result.status == 0);
  CHECK_THAT(result.output, Catch::Contains("| 1 thread, all/step | ms | 10 | 5 | 0.5 |"));
  check_failure(ballast_program({"bench", "diff", a, folder.write("c.json", "[]").string()}),
                ExitCode::failure, {"c.json", "is no result of ballast bench"});
  write_bench_result(folder.path(), "kernels", "ballast bench kernels", {});
  const std::string other = (folder.path() / "kernels.json").string();
  check_failure(ballast_program({"bench", "diff", a, other}), ExitCode::failure,
                {other, "kind = \"kernels\", expected \"step\""});
}

TEST_CASE("steps are measured, and how is kept with them") {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "bench";
  const ProgramResult result =
      ballast_program({"bench", "step", "vibrated_box_small", "--set", "grains.count=12", "--set",
                       "box.length=0.12", "--set", "box.width=0.12", "--set",
                       "control_volume.margin_x=0.02", "--steps", "5", "--packing-cache",
                       (folder.path() / "packings").string(), "--output", output.string()});
  INFO(result.errors);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.output, Catch::Contains("1 thread, all/step"));
  const BenchResult kept = read_bench_result(output / "step.json");
  CHECK_THAT(kept.command,
             Catch::StartsWith("ballast bench step vibrated_box_small --set grains.count=12 ") &&
                 Catch::Contains(" --steps 5 "));
  REQUIRE_FALSE(kept.measurements.empty());
  CHECK(kept.measurements[0].samples == 5);
}

namespace {

/// A page that times a step and another program twice each, a comparison, and a run. Sanitizers
/// take more address space than the comparison's limit, so that it has none.
const char* const small_page = R"(<!--
step x2: bench step BOX --steps 3 --packing-cache packings
other x2: beside
known x1: compare known:contacts=12,bodies=6,count=3 --solvers pgs,nncg --memory 0 --no-report
run x1: run zeno_ball --set scene.duration=0.01 --no-report --continue
-->
|{{step: 1 thread, all/step over other: step}}|{{known: pgs to 0.0001, solved}}|
|{{known: pgs to 0.0001, cases solved}}|
|{{run: steps_left}}|
{{known: pgs to 0.0001, beside the others}} {{known: nncg to 0.0001, beside the others}}
{{known: pgs to 0.0001, beside the others, as measured}}
{{known}} on {{date}}
)";

std::string page_of_small_box() {
  std::string page = small_page;
  page.replace(page.find("BOX"), 3,
               "vibrated_box_small --set grains.count=12 --set box.length=0.12 --set "
               "box.width=0.12 --set control_volume.margin_x=0.02");
  return page;
}

}  // namespace

TEST_CASE("a page of results is measured by its own commands, once, and made again of its rows") {
  const TemporaryFolder folder;
  const std::string page = folder.write("page.md", page_of_small_box()).string(),
                    output = (folder.path() / "all").string();
  const auto all = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"bench", "all", "--page", page});
    return ballast_program(more);
  };
  const std::vector<std::string> words{"--output", output, "--beside", "echo one step: 1e-9"};
  const ProgramResult first = all(words);
  INFO(first.errors);
  REQUIRE(first.status == 0);
  CHECK_THAT(first.output, Catch::Contains("step/1") && Catch::Contains("other/2"));
  const std::string told = read_whole_file(folder.path() / "all" / "results.md");
  const std::string shares = "|100|\n|3|\n|0|\n";
  CHECK_THAT(told, Catch::Contains(shares) &&
                       Catch::Contains("`ballast compare known:contacts=12,bodies=6,count=3 "));
  // With two backends the two ratios are reciprocal.
  std::istringstream cells(told.substr(told.find(shares) + shares.size()));
  double pgs = 0.0, nncg = 0.0;
  cells >> pgs >> nncg;
  CHECK(pgs * nncg == Approx(1.0).epsilon(0.03));
  double over = 0.0;  // the step's time over 1e-9 ms
  std::istringstream(told.substr(1)) >> over;
  CHECK(over > 1e6);

  const ProgramResult again = all(words);
  CHECK(again.status == 0);
  CHECK_THAT(again.output, !Catch::Contains("step/1"));
  CHECK(read_whole_file(folder.path() / "all" / "results.md") == told);
  // Without the other program its earlier times are not used.
  CHECK(all({"--output", output}).status == 0);
  CHECK_THAT(read_whole_file(folder.path() / "all" / "results.md"), Catch::StartsWith("|–|100|\n"));
  CHECK(all(words).status == 0);
  const std::string copy = (folder.path() / "copy").string();
  CHECK(all({"--output", copy, "--rows", output + "/measured/numbers.csv"}).status == 0);
  CHECK(read_whole_file(folder.path() / "copy" / "results.md") == told);

  // Rows with known times: the ratios are printed with 10 us added to both times, and without.
  for (const auto& file : std::filesystem::directory_iterator(output + "/known/1/rows")) {
    CompareRow row = compare_row_of_json(read_whole_file(file.path()), file.path().string());
    row.prepare_seconds = 0.0;
    row.solve_seconds = row.solver == "pgs" ? 10e-6 : 30e-6;
    write_whole_file(file.path(), to_json(row));
  }
  CHECK(all(words).status == 0);
  CHECK_THAT(read_whole_file(folder.path() / "all" / "results.md"),
             Catch::Contains("\n0.50 2.00\n0.33\n"));
}

TEST_CASE("docs/results.md is the page of docs/measured/numbers.csv") {
  const TemporaryFolder folder;
  const std::string docs = BALLAST_SOURCE_FOLDER "/docs",
                    output = (folder.path() / "page").string();
  // `ballast bench all --rows docs/measured/numbers.csv --output docs`
  const ProgramResult made = ballast_program(
      {"bench", "all", "--rows", docs + "/measured/numbers.csv", "--output", output});
  INFO(made.errors);
  REQUIRE(made.status == 0);
  CHECK(read_whole_file(output + "/results.md") == read_whole_file(docs + "/results.md"));
}

TEST_CASE("a page of results that cannot be measured says why") {
  const TemporaryFolder folder;
  const auto complaint = [&](const std::string& page, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"bench", "all", "--page", folder.write("page.md", page).string(),
                               "--output", (folder.path() / "all").string()});
    return ballast_program(more);
  };
  CHECK(complaint("<!--\nother x1: beside\n-->\n{{other: step}}\n").status == 0);  // no --beside
  CHECK(read_whole_file(folder.path() / "all" / "results.md") == "–\n");
  check_failure(complaint("no stages\n"), ExitCode::failure,
                {"page.md: does not begin with its stages"});
  check_failure(complaint("<!--\nlist solvers\n-->\n"), ExitCode::failure,
                {"'list solvers'", "expected NAME xTURNS: WORDS"});
  check_failure(complaint("<!--\nlist '': solvers\n-->\n"), ExitCode::failure,
                {"list ''", "expected NAME xTURNS: WORDS"});
  check_failure(complaint("<!--\n-->\n"), ExitCode::failure, {"has no stages"});
  check_failure(complaint("<!--\n../list x1: solvers\n-->\n"), ExitCode::failure, {"'../list x1"});
  check_failure(complaint("<!--\nlist x1: solvers --nothing\n-->\n"), ExitCode::failure,
                {"list failed", "list/1.log"});
  check_failure(
      complaint("<!--\nother x1: beside\n-->\n{{other}} {{a step}}\n", {"--beside", "echo 1"}),
      ExitCode::failure, {"{{a step}}"});
  check_failure(complaint("<!--\nother x1: beside\n-->\n{{other: wall}}\n", {"--beside", "echo 1"}),
                ExitCode::failure, {"other measures no 'wall'"});
  check_failure(complaint("<!--\nother x1: beside\n-->\n", {"--beside", "echo none"}),
                ExitCode::failure, {"'echo none'", "its last word is no number"});
  // The other program is found from the folder of the user, and its complaint is shown.
  const ProgramResult found = ballast_in_shell(
      "cd '" + folder.path().string() + "' && echo 'echo 2.5' > other.sh && \"$@\"",
      {"bench", "all", "--page",
       folder
           .write("page.md",
                  "<!--\nother x1: beside\n-->\n"
                  "{{other: step}}\n")
           .string(),
       "--output", "mine", "--beside", "sh ./other.sh"});
  INFO(found.errors);
  CHECK(found.status == 0);
  CHECK(read_whole_file(folder.path() / "mine" / "results.md") == "2.5\n");
  check_failure(complaint("<!--\nother x1: beside\n-->\n", {"--beside", "cat /no/such/file"}),
                ExitCode::failure, {"'cat /no/such/file' failed", "No such file"});
}
