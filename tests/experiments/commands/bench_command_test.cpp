// `ballast bench` as it is called: two results side by side, and a short measurement.

#include <filesystem>

#include "experiments/bench/measurement.hpp"
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
}

TEST_CASE("steps are measured, and how is kept with them") {
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "bench";
  const ProgramResult result = ballast_program(
      {"bench", "step", "vibrated_box_small", "--set", "grains.count=12", "--set",
       "box.length=0.12", "--set", "box.width=0.12", "--set", "control_volume.margin_x=0.02",
       "--steps", "5", "--no-plot", "--packing-cache", (folder.path() / "packings").string(),
       "--output", output.string()});
  INFO(result.errors);
  REQUIRE(result.status == 0);
  CHECK_THAT(result.output, Catch::Contains("1 thread, all/step"));
  const BenchResult kept = read_bench_result(output / "step.json");
  CHECK_THAT(kept.command,
             Catch::StartsWith("ballast bench step vibrated_box_small --set grains.count=12 ") &&
                 Catch::Contains(" --steps 5 --no-plot "));
  REQUIRE_FALSE(kept.measurements.empty());
  CHECK(kept.measurements[0].samples == 5);
  CHECK_FALSE(std::filesystem::exists(output / "step.svg"));
}
