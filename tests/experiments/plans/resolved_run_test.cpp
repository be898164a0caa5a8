#include "experiments/plans/resolved_run.hpp"

#include "experiments/box/vibrated_box.hpp"
#include "experiments/run/run_folder.hpp"
#include "platform/row_log.hpp"
#include "problems/scene/scene_file.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;
namespace fs = std::filesystem;

TEST_CASE("a run of a box: its key, its packing, its steps, and its work") {
  const PlannedRun planned{"a", "vibrated_box_small", {"scene.duration=0.06", "grains.count=20"}};
  const ResolvedRun run = resolve(planned);
  CHECK(run.key == run_key(planned));
  CHECK(run.packing == packing_key(read_scene(find_scene(planned.scene), planned.overrides)));
  CHECK(run.steps == 300);  // 0.06 s of 2e-4 s
  CHECK(run.work == 20.0 * 300.0);
  // a third of the longest rain and the lid's 0.1 s at 5e-4 s, the rest's 0.05 s at 2e-4 s
  CHECK(run.packing_work == Approx(20.0 * ((1.0 + 0.1) / 5e-4 + 0.05 / 2e-4)));
}

TEST_CASE("a run of single bodies has no packing") {
  const ResolvedRun run = resolve(PlannedRun{"a", "incline", {}});
  CHECK(run.packing.empty());
  CHECK(run.packing_work == 0.0);
  const Scene scene = read_scene(find_scene("incline"));
  CHECK(run.work == static_cast<double>(scene.bodies.size()) * static_cast<double>(run.steps));
}

TEST_CASE("what the program is asked to do, and where it is put") {
  ResolvedRun run;
  run.run = {"a", "box", {"x=1", "y=2"}};
  run.key = "cafe";
  CHECK(run_folder("r", run) == fs::path("r/runs/cafe"));
  CHECK(run_arguments("r", run) == std::vector<std::string>{"run", "box", "--set", "x=1", "--set",
                                                            "y=2", "--packing-cache", "r/packings",
                                                            "--output", "r/runs/cafe", "--continue",
                                                            "--no-report"});
  CHECK(deposit_arguments("r", run) == std::vector<std::string>{"run", "box", "--set", "x=1",
                                                                "--set", "y=2", "--packing-cache",
                                                                "r/packings", "--deposit-only"});
}

TEST_CASE("steps are counted in the log of a run, also of one that is being written") {
  const TemporaryFolder folder;
  CHECK(steps_in_log(folder.path()) == 0);
  const fs::path log = RunFolder(folder.path()).steps_log();
  fs::create_directories(log.parent_path());
  std::ofstream(log) << "torn";
  CHECK(steps_in_log(folder.path()) == 0);
  RowWriter writer(log, RowLogHeader{"columns", 7, 3});
  for (int k = 0; k < 5; ++k) writer.append(std::vector<double>{1.0, 2.0, 3.0});
  writer.flush();
  CHECK(steps_in_log(folder.path()) == 5);
  std::ofstream(log, std::ios::app) << "half a row";
  CHECK(steps_in_log(folder.path()) == 5);
}
