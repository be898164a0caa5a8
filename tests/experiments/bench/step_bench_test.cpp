// Whole steps by phase and state of the wall.

#include "experiments/bench/step_bench.hpp"

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
  // two threads: the same motion
  const std::vector<BenchStep> two =
      measure_steps(tiny_box().scene, driven_start(tiny_box()), 60, 2);
  for (const StepColumn& column : step_columns())
    if (std::string(column.name).rfind("seconds_", 0) != 0) {
      CAPTURE(column.name);
      CHECK(two.back().record.*column.value == steps.back().record.*column.value);
    }
  CHECK(step_figure(steps, 10).panels[0].curves[0].x.size() == 10);
}
