// Reading a run's folder: what is there is read, what is missing or broken is said.

#include "experiments/measure/run_data.hpp"

#include <cmath>
#include <fstream>

#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/synthetic_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
using Catch::Contains;

namespace {

std::vector<StepRecord> some_steps() {
  SyntheticBox box;
  box.duration = 0.01;
  return synthetic_box(box);
}

}  // namespace

TEST_CASE("steps.csv gives back every bit of every column") {
  const TemporaryFolder folder;
  const auto steps = some_steps();
  write_steps_csv(folder.path() / "steps.csv", steps);
  std::vector<std::string> notices;
  const auto read = read_steps_csv(folder.path() / "steps.csv", notices);
  CHECK(notices.empty());
  REQUIRE(read.size() == steps.size());
  for (size_t k = 0; k < steps.size(); ++k)
    for (const StepColumn& column : step_columns())
      CHECK(read[k].*column.value == steps[k].*column.value);
}

TEST_CASE("columns may be missing, foreign, or of Windows") {
  const TemporaryFolder folder;
  std::vector<std::string> notices;
  const auto read = read_steps_csv(
      folder.write("steps.csv", "wall_x,colour,time\r\n 1.5 ,7,0.1\r\n2,8,0.2\r\n"), notices);
  REQUIRE(read.size() == 2);
  CHECK(read[0].wall_x == 1.5);
  CHECK(read[1].time == 0.2);
  CHECK(std::isnan(read[0].load));
  REQUIRE(notices.size() == 1);
  CHECK_THAT(notices[0], Contains("has no column") && Contains("load"));
}

TEST_CASE("a damaged steps.csv is refused by file, line and column") {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& text) -> std::string {
    std::vector<std::string> notices;
    try {
      read_steps_csv(folder.write("steps.csv", text), notices);
    } catch (const Error& error) {
      return error.what();
    }
    return "read";
  };
  CHECK_THAT(message(""), Contains("steps.csv: is empty"));
  CHECK_THAT(message("time\n"), Contains("steps.csv: holds no step"));
  CHECK_THAT(message("wall_x\n1\n"), Contains("\"time\" is missing"));
  CHECK_THAT(message("time,load\n0.1\n"), Contains("steps.csv:2: 1 fields, expected 2"));
  CHECK_THAT(message("time,load\n0.1,1\n0.2,1e\n"),
             Contains("steps.csv:3: load is not a number: \"1e\""));
}

TEST_CASE("a folder without manifest and scene is read with a notice of each") {
  const TemporaryFolder folder;
  auto steps = some_steps();
  steps[3].load = not_known;
  write_steps_csv(folder.path() / "steps.csv", steps);
  const RunData data = read_run_data(folder.path());
  CHECK_FALSE(data.scene);
  CHECK(std::isnan(data.summary_number("step_s")));
  REQUIRE(data.notices.size() == 3);
  CHECK_THAT(data.notices[0], Contains("load is not finite in 1 of") && Contains("in row 4"));
  CHECK_THAT(data.notices[1], Contains("manifest.json is missing"));
  CHECK_THAT(data.notices[2], Contains("scene.toml is missing"));
}

TEST_CASE("facts come from the manifest, what it lacks from the scene") {
  const TemporaryFolder folder;
  write_steps_csv(folder.path() / "steps.csv", some_steps());
  folder.write("manifest.json",
               R"({"summary": {"grain_mass_kg": 100, "f_max_N": 7, "step_s": 1}})");
  std::ofstream(folder.path() / "scene.toml") << resolved_scene_text(find_scene("vibrated_box"));
  const RunData data = read_run_data(folder.path());
  REQUIRE(data.scene);
  CHECK(data.facts.step == 1.0);
  CHECK(data.facts.f_max == 7.0);
  CHECK(data.facts.gravity == Approx(9.81));
  CHECK(data.facts.frequency == 5.0);
  CHECK(data.facts.tolerance == 0.01);
  CHECK(data.facts.wall_mass == Approx(50.0));
  CHECK(*data.facts.has_wall);
}

TEST_CASE("a record whose time does not grow is refused, as is a folder that isn't there") {
  const TemporaryFolder folder;
  folder.write("steps.csv", "time\n0.1\n0.1\n");
  CHECK_THROWS_WITH(read_run_data(folder.path()), Contains("not finite and growing in row 2"));
  CHECK_THROWS_WITH(read_run_data(folder.path() / "none"), Contains("no such folder"));
}
