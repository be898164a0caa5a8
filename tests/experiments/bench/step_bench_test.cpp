// The bench of whole steps, by phase of the step and state of the wall.

#include "experiments/bench/step_bench.hpp"

#include <set>

#include "experiments/step/time_step.hpp"
#include "tests/catch.hpp"
#include "tests/experiments/bench/tiny_box.hpp"

using namespace ballast;

TEST_CASE("Steps are split into phases and states of the wall") {
  const std::vector<BenchStep> steps =
      measure_steps(tiny_box().scene, driven_start(tiny_box()), 60, 1);
  REQUIRE(steps.size() == 60);
  const std::vector<Measurement> all = step_measurements(tiny_box().scene, steps, 1);
  double parts = 0.0, states = 0.0, whole = 0.0;
  for (const Measurement& m : all) {
    if (m.group == "1 thread, all" && m.name == "step") whole = m.mean;
    for (const char* part : {"detect", "assemble", "solve", "judge", "correct", "other"})
      if (m.group == "1 thread, all" && m.name == part) parts += m.mean;
    if (m.group != "1 thread, all" && m.name == "step") states += static_cast<double>(m.samples);
  }
  CHECK(parts == Approx(whole).epsilon(1e-9));
  CHECK(states == 60.0);
  CHECK(value_of(all, "1 thread, all/contacts") > 0.0);
  // With two threads the motion is the same.
  const std::vector<BenchStep> two =
      measure_steps(tiny_box().scene, driven_start(tiny_box()), 60, 2);
  for (const StepColumn& column : step_columns())
    if (std::string(column.name).rfind("seconds_", 0) != 0) {
      CAPTURE(column.name);
      CHECK(two.back().record.*column.value == steps.back().record.*column.value);
    }
}

TEST_CASE("Every kernel does what it is timed for, again and again, and is found by its name") {
  const std::vector<Kernel> kernels = step_kernels(tiny_box(), 2);
  std::set<std::string> names;
  for (const Kernel& kernel : kernels) {
    INFO(kernel.group << "/" << kernel.name);
    CHECK(names.insert(kernel.group + "/" + kernel.name).second);
    CHECK(kernel.items > 1.0);
  }
  CHECK(names.contains("detection/from scratch"));
  KernelBenchOptions options;
  options.min_time = 1e-4;
  options.repeats = 3;
  const auto all = run_kernels(kernels, options);
  REQUIRE(all.size() == kernels.size());
  for (const Measurement& m : all) {
    INFO(m.full_name());
    CHECK(m.low > 0.0);
    CHECK(m.samples == 3);
  }
  options.filter = "em/jud";
  CHECK(run_kernels(kernels, options).at(0).name == "judge");
  options.filter = "no such kernel";
  CHECK_THROWS_WITH(run_kernels(kernels, options), Catch::Contains("no such kernel"));
}

TEST_CASE("Scaling deposits boxes of tiles, and measures each in its own process") {
  CHECK(tiles_for(1000, 1200) == std::pair(1, 1));
  CHECK(tiles_for(10000, 1200) == std::pair(3, 3));
  CHECK(tiles_for(100000, 1200) == std::pair(9, 9));
  const TemporaryFolder cache;
  ScalingOptions options;
  options.grains = {12, 48};
  options.warm_up = options.steps = 2;
  std::vector<ScalingPoint> points;
  measure_scaling(tiny_box().scene, cache.path(), options,
                  [&](const ScalingPoint& point) { points.push_back(point); });
  REQUIRE(points.size() == 2);
  CHECK(points[0].grains == 12.0);
  CHECK(points[1].grains == 48.0);
  CHECK(points[1].value("contacts") > 2.0 * points[0].value("contacts"));
  for (const ScalingPoint& p : points) {
    CHECK(p.measured[0].group ==
          (p.grains == 12.0 ? "1 thread, 12 grains" : "1 thread, 48 grains"));
    CHECK(p.value("step") >= p.value("detect"));
    CHECK(p.value("memory") > 0.0);
  }
  // What goes wrong in the process is said.
  const auto file = cache.write("file", "");
  CHECK_THROWS_WITH(
      measure_scaling(tiny_box().scene, file, options, [](const ScalingPoint&) {}),
      Catch::Contains("bench scaling: 12 grains: ") && Catch::Contains(file.string()));
}

TEST_CASE("A settled box rests behind walls that stand still") {
  PreparedRun start = settled_start(tiny_box());
  CHECK(start.system.first_driven_wall() == -1);
  CHECK(start.memory.contacts.size() == start.memory.impulses.size());
  TimeStepper stepper(start.system, tiny_box().scene, -1);
  for (int k = 0; k < 5; ++k) stepper.step(start.state, start.memory);
  const DepositSpec& deposit = tiny_box().scene.deposit;
  CHECK(grain_rms_velocity(start.system, start.state) < 10 * deposit.rest_velocity);
}

TEST_CASE("A scene without grains has no packing to measure") {
  CHECK_THROWS_WITH(bench_scene("sliding_cube", {}),
                    "sliding_cube: has no grains: a bench needs a deposited packing");
}

TEST_CASE("The driven box begins as it was deposited, behind a wall that is driven") {
  const PreparedRun start = driven_start(tiny_box());
  CHECK(start.system.grain_count == 12);
  CHECK(start.system.first_driven_wall() >= 0);
  CHECK(start.memory.contacts.size() == start.memory.impulses.size());
  for (size_t b = 0; b < 12; ++b)
    CHECK(start.state.pose[b].position == tiny_box().packing.state.pose[b].position);
}
