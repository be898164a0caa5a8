// The instruments of `ballast bench`: what they measure is what they say, not how fast it is.

#include <cmath>
#include <iostream>
#include <sstream>

#include "experiments/bench/accuracy_bench.hpp"
#include "experiments/bench/kernels.hpp"
#include "experiments/bench/scaling_bench.hpp"
#include "experiments/bench/step_bench.hpp"
#include "experiments/bench/sweep_floor.hpp"
#include "experiments/compare/compare_options.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/sweep_kernels.hpp"
#include "solvers/solver_list.hpp"
#include "tests/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace ballast;

namespace {

const std::vector<std::string> tiny = {"grains.count=12", "box.length=0.12", "box.width=0.12",
                                       "control_volume.margin_x=0.02"};

struct Silence {
  Silence() : old(std::cout.rdbuf(sink.rdbuf())) {}
  ~Silence() { std::cout.rdbuf(old); }
  std::ostringstream sink;
  std::streambuf* old;
};

/// Deposited once for all tests of this program.
const DepositedBox& tiny_box() {
  static const DepositedBox box = [] {
    const TemporaryFolder folder;
    const Silence silence;
    deposited_box("vibrated_box_small", tiny, folder.path());
    return deposited_box("vibrated_box_small", tiny, folder.path());  // from the cache
  }();
  return box;
}

double value_of(const std::vector<Measurement>& measurements, const std::string& name) {
  for (const Measurement& m : measurements)
    if (m.full_name() == name) return m.median;
  FAIL("no measurement " << name);
  return 0.0;
}

}  // namespace

TEST_CASE("A measurement has the quartiles of its values") {
  const Measurement m = measurement_of("g", "n", "ms", {4.0, 1.0, 2.0, 3.0, 10.0});
  CHECK(m.median == 3.0);
  CHECK(m.mean == 4.0);
  CHECK(m.low == 2.0);
  CHECK(m.high == 4.0);
  CHECK(m.samples == 5);
  CHECK(measurement_of("g", "n", "ms", {1.0, 2.0}).median == 1.5);
  CHECK_THROWS_AS(measurement_of("g", "n", "ms", {}), std::invalid_argument);
}

TEST_CASE("Results are written, read and compared") {
  const TemporaryFolder folder;
  MachineFacts facts;
  facts.read_GB_s = 12.5;
  const auto a = measurement_of("sweep", "pgs", "ns", {10.0}),
             b = measurement_of("sweep", "pgs", "ns", {5.0}),
             other = measurement_of("sweep", "jacobi", "ns", {7.0});
  write_bench_result(folder.path() / "a", "kernels", "ballast bench kernels", facts, {a, other});
  write_bench_result(folder.path() / "b", "kernels", "ballast bench kernels", facts, {b});
  const BenchResult first = read_bench_result(folder.path() / "a" / "kernels.json");
  CHECK(first.kind == "kernels");
  CHECK_FALSE(first.commit.empty());
  REQUIRE(first.measurements.size() == 2);
  CHECK(first.measurements[0].median == 10.0);
  const std::string table =
      bench_ratio_table(first, read_bench_result(folder.path() / "b" / "kernels.json"));
  CHECK_THAT(table, Catch::Contains("| sweep/pgs | ns | 10 | 5 | 0.5 |"));
  CHECK_THAT(table, Catch::Contains("only in A: sweep/jacobi"));
  CHECK_THAT(read_whole_file(folder.path() / "a" / "kernels.csv"),
             Catch::Contains("sweep,jacobi,ns,7,"));
  write_whole_file(folder.path() / "bad.json", "{\"kind\": 3}");
  CHECK_THROWS_WITH(read_bench_result(folder.path() / "bad.json"), Catch::Contains("bad.json"));
  CHECK_THROWS_AS(read_bench_result(folder.path() / "none.json"), Error);
}

TEST_CASE("Copies side by side are the packing again and again") {
  const DepositedBox& box = tiny_box();
  BenchStart one = tiled_start(box, 1, 1), six = tiled_start(box, 3, 2);
  REQUIRE(six.system.grain_count == 6 * 12);
  REQUIRE(six.state.pose.size() == six.system.bodies.size());
  CHECK(six.system.first_driven_wall() == -1);
  for (size_t c = 1; c < six.memory.contacts.size(); ++c) {
    const ContactPoint &p = six.memory.contacts[c - 1], &q = six.memory.contacts[c];
    CHECK(std::tuple(p.body_a, p.body_b, p.feature) < std::tuple(q.body_a, q.body_b, q.feature));
  }
  // walls between the copies are gone, and with them their contacts alone
  size_t inner = 0;
  for (const ContactPoint& c : one.memory.contacts) {
    const int wall = c.body_a - 12;
    if (wall == wall_x_min || wall == wall_x_max)
      inner += 2 * 2;  // on each side 2 of 3 columns, 2 rows
    if (wall == wall_y_min || wall == wall_y_max) inner += 3;
  }
  CHECK(six.memory.contacts.size() == 6 * one.memory.contacts.size() - inner);
  const auto deepest = [&](BenchStart& start) {
    TimeStepper stepper(start.system, step_settings(box.scene), -1);
    double depth = 0.0;
    for (int k = 0; k < 5; ++k)
      depth = std::max(depth, stepper.step(start.state, start.memory).penetration_max);
    return depth;
  };
  CHECK(deepest(six) <= deepest(one) + 1e-5);  // no copy lies in another
}

TEST_CASE("A repeated problem is its copies") {
  const KernelProblem problem = kernel_problem(tiny_box(), 3);
  REQUIRE(problem.problem.contact_count() > 0);
  const FrictionProblem three = repeated(problem.problem, 3);
  three.validate();
  CHECK(three.contact_count() == 3 * problem.problem.contact_count());
  const ContactError one = contact_error(problem.problem, problem.warm),
                     all = contact_error(three, repeated(problem.warm, 3));
  CHECK(one.natural_map_rms > 0.0);
  CHECK(all.natural_map_rms == Approx(one.natural_map_rms).epsilon(1e-12));
  CHECK(all.natural_map_max == one.natural_map_max);
}

TEST_CASE("Pairs for the pair test touch or do not") {
  for (const int vertices : {8, 37})
    for (const bool touching : {true, false}) {
      const GrainPairs pairs = grain_pairs(vertices, touching, 6);
      REQUIRE(pairs.count() == 6);
      for (const auto& shape : pairs.shapes) CHECK(shape->vertex_count() == vertices);
      DetectionSettings cold;
      cold.skin = pairs.skin;
      cold.use_cache = false;
      DetectionSettings cached = cold;
      cached.use_cache = true;
      ContactDetector a(pairs.contact_shapes(), cold), b(pairs.contact_shapes(), cached);
      const std::vector<double> reach(pairs.shapes.size(), pairs.reach);
      std::vector<ContactPoint> found, again;
      for (const auto& poses : pairs.poses) {
        a.detect(poses, reach, found);
        b.detect(poses, reach, again);
        CHECK(a.counters().candidate_pairs == 6);
        CHECK(a.counters().manifolds == (touching ? 6 : 0));
        CHECK(again.size() == found.size());
      }
    }
}

TEST_CASE("The floor counts the records that the sweep reads") {
  CHECK(friction_cost().streamed_bytes() == sizeof(FrictionRecord) + 2 * sizeof(FrictionImpulse));
  // 3 rows x (6 + 6 products, 11 sums), 72 for the bodies, 21 of its own
  CHECK(friction_cost().flops == 3 * 23 + 72 + 21);
  CHECK(friction_cost().executed_flops > friction_cost().flops);
  CHECK(one_row_cost().flops < friction_cost().flops / 2);
  const SweepFloor floor = sweep_floor(kernel_problem(tiny_box(), 1).problem);
  CHECK(floor.bytes <= friction_cost().streamed_bytes());
  CHECK(floor.bytes >= one_row_cost().streamed_bytes());
  CHECK(sweep_floor(FrictionProblem{}).bytes == 0.0);
}

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

TEST_CASE("Scaling measures each packing in its own process") {
  CHECK(tiles_for(1000, 1200) == std::pair(1, 1));
  CHECK(tiles_for(10000, 1200) == std::pair(3, 3));
  CHECK(tiles_for(100000, 1200) == std::pair(9, 9));
  ScalingOptions options;
  options.grains = {12, 48};
  options.warm_up = options.steps = options.sweeps = 2;
  options.solvers = {"pgs"};
  options.max_iterations = 50;
  int heard = 0;
  const auto points = measure_scaling(tiny_box(), options, [&](const ScalingPoint&) { ++heard; });
  REQUIRE(points.size() == 2);
  CHECK(heard == 2);
  CHECK(points[0].grains == 12.0);
  CHECK(points[1].grains == 48.0);
  CHECK(points[1].contacts > 2.0 * points[0].contacts);
  for (const ScalingPoint& p : points) {
    CHECK(p.sweep > 0.0);
    CHECK(p.step >= p.detect);
    REQUIRE(p.iterations.size() == 1);
    CHECK((p.iterations[0] <= 50.0 || std::isinf(p.iterations[0])));
    REQUIRE(p.seconds.size() == 1);
    CHECK(p.seconds[0] > 0.0);
  }
  CHECK(scaling_figure(options, points).panels[0].curves[0].x == std::vector<double>{12.0, 48.0});
  options.grains = {12};
  options.cold_start = true;
  options.max_iterations = 1;  // from nothing, one sweep does not do
  const auto cold = measure_scaling(tiny_box(), options, [](const ScalingPoint&) {});
  CHECK(std::isinf(cold[0].iterations[0]));
  CHECK(scaling_figure(options, cold).panels[1].curves[0].x.empty());
  const auto words = scaling_measurements(options, cold);
  CHECK(std::any_of(words.begin(), words.end(), [](const Measurement& m) {
    return m.name == "time, tolerance not reached, pgs";
  }));
}

TEST_CASE("More iterations cost more and err less") {
  const TemporaryFolder folder;
  AccuracyOptions options;
  options.live.scene = "vibrated_box_small";
  options.live.overrides = tiny;
  options.live.solvers = parse_solvers("pgs");
  options.live.tolerances = {1e-8};
  options.live.duration = 4e-3;
  options.live.folder = folder.path();
  options.iterations = {2, 30};
  const Silence silence;
  std::vector<std::string> labels;
  const auto rows = measure_accuracy(options, [&](const Trajectory& t) {
    labels.push_back(t.label());
    return true;
  });
  REQUIRE(rows.size() == 3);
  CHECK(labels == std::vector<std::string>{"pgs 1e-08", "pgs 2 iterations", "pgs 30 iterations"});
  for (const AccuracyRow& row : rows) CHECK(row.complete);
  CHECK(rows[0].error_worst <= 1e-8);
  CHECK(rows[0].distance == 0.0);
  CHECK(rows[1].limit == "2 iterations");
  CHECK(rows[1].iterations == 2.0);
  CHECK(rows[1].error_mean > rows[2].error_mean);
  CHECK(rows[1].distance > 0.0);
  CHECK(value_of(accuracy_measurements(rows), "pgs, 30 iterations/iterations") == 30.0);
}

TEST_CASE("Kernels run by name, or the library is named that is missing") {
  const KernelProblem problem = kernel_problem(tiny_box(), 2);
  KernelBenchOptions options;
  options.min_time = 1e-4;
  options.repeats = 3;
  options.streaming_MB = 0.1;
  try {
    options.filter = "one contact|problem/judge";
    const auto measured = run_kernels(problem, options, MachineFacts{});
    CHECK(value_of(measured, "one contact/stick") > 0.0);
    CHECK(value_of(measured, "problem/judge") > 0.0);
    CHECK(value_of(measured, "floor/sweep bytes streamed") > 0.0);
    for (const Measurement& m : measured)
      CHECK_THAT(m.full_name(), Catch::StartsWith("one contact/") || Catch::StartsWith("floor/") ||
                                    Catch::Equals("problem/judge"));
    options.filter = "no such kernel";
    CHECK_THROWS_WITH(run_kernels(problem, options, MachineFacts{}),
                      Catch::Contains("no such kernel"));
  } catch (const MissingSolver& missing) {
    CHECK_THAT(missing.what(), Catch::Contains("Google Benchmark"));
  }
}
