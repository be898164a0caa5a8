#include "experiments/bench/step_bench.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>

#include "experiments/measure/curve_fit.hpp"
#include "experiments/measure/wall_cycles.hpp"
#include "experiments/step/step_record.hpp"
#include "experiments/step/time_step.hpp"
#include "platform/clock.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/pack.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "problems/algebra/contact_error.hpp"
#include "solvers/gauss_seidel/any_sweep.hpp"

namespace ballast {
namespace {

/// A step of the driven box, with the problem that it solved.
struct StepWork {
  const double h;
  PreparedRun start;
  TimeStepper stepper;
  ProblemAssembler assembler;
  ContactJudge judge;
  Eigen::VectorXd v_free;
  Impulses warm;

  StepWork(const DepositedBox& box, int steps)
      : h(box.scene.step),
        start(driven_start(box)),
        stepper(start.system, box.scene, start.system.first_driven_wall()),
        assembler(start.system) {
    for (int k = 0; k < steps; ++k) stepper.step(start.state, start.memory);
    stepper.warm_start(start.memory, warm);
    assembler.pack(start.state, v_free);
    assemble();
  }
  void assemble() {
    const double end = start.state.time + h;
    assembler.assemble({start.state, start.memory.contacts, v_free, h, end});
  }
};

struct DetectionWork {
  ContactDetector detector;
  std::vector<Pose> poses;
  std::vector<double> reach;
  std::vector<ContactPoint> contacts;

  DetectionWork(const PreparedRun& start, DetectionSettings settings, bool use_cache)
      : detector(contact_shapes(start.system), (settings.use_cache = use_cache, settings)),
        poses(start.state.pose),
        reach(poses.size(), 0.0) {}
  void all() { detector.detect(poses, reach, contacts); }
};

struct SweepWork {
  const FrictionProblem problem;
  AnySweep sweep;

  SweepWork(const StepWork& step, bool in_single) : problem(step.stepper.problem()) {
    sweep.prepare(problem);
    sweep->allow_single(in_single);
    sweep->load(problem, step.warm);
    sweep->start_search();
  }
};

/// "1 thread", "2 threads"
std::string thread_words(int threads) {
  return std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

/// CPU ns per item of each repetition. The first call is not timed: it fills buffers and caches.
std::vector<double> samples_of(const Kernel& kernel, const KernelBenchOptions& options) {
  kernel.call();
  std::vector<double> samples;
  for (long calls = 1; samples.size() < static_cast<size_t>(options.repeats);) {
    const double begin = processor_seconds();
    for (long k = 0; k < calls; ++k) kernel.call();
    const double seconds = processor_seconds() - begin;
    if (seconds < options.min_time)
      calls *= 2;
    else
      samples.push_back(1e9 * seconds / (static_cast<double>(calls) * kernel.items));
  }
  return samples;
}

/// Adds the measurements of a set of steps. `scale` [m/s]: velocity_scale().
void add_group(const std::string& group, const std::vector<const BenchStep*>& steps, double scale,
               std::vector<Measurement>& to) {
  if (steps.empty()) return;
  const auto add = [&](const std::string& name, const char* unit, const auto& value) {
    std::vector<double> values;
    for (const BenchStep* step : steps) values.push_back(value(*step));
    to.push_back(measurement_of(group, name, unit, std::move(values)));
  };
  const auto column = [&](const std::string& name, const char* unit, double StepRecord::*value,
                          double factor = 1.0) {
    add(name, unit, [=](const BenchStep& s) { return factor * (s.record.*value); });
  };
  const auto pairs = [&](const char* name, long DetectionCounters::*count) {
    add(name, "pairs", [=](const BenchStep& s) { return static_cast<double>(s.counters.*count); });
  };
  add("step", "ms", [](const BenchStep& s) { return 1e3 * step_seconds(s.record); });
  add("step, CPU", "ms", [](const BenchStep& s) { return 1e3 * s.cpu_seconds; });
  for (const StepColumn& phase : step_phases()) column(phase.phase_word(), "ms", phase.value, 1e3);
  pairs("pairs in the broad phase's list", &DetectionCounters::candidate_pairs);
  pairs("separated by the cache", &DetectionCounters::cached_separations);
  pairs("cached axis proved", &DetectionCounters::proved_axes);
  pairs("full searches", &DetectionCounters::full_tests);
  pairs("touching pairs", &DetectionCounters::manifolds);
  column("contacts", "contacts", &StepRecord::contacts);
  column("active contacts", "contacts", &StepRecord::active_contacts);
  column("iterations", "iterations", &StepRecord::iterations);
  column("error rms", "g h", &StepRecord::error_rms, 1.0 / scale);
  column("error of the worst contact", "g h", &StepRecord::error_max, 1.0 / scale);
  column("penetration max", "um", &StepRecord::penetration_max, 1e6);
}

/// Steps a packing of the cache and measures the steps: the work of the child.
void measure_packing(Scene scene, const std::filesystem::path& cache, const ScalingOptions& options,
                     ScalingPoint& point) {
  const std::string group = thread_words(point.threads) + printed(", %.0f grains", point.grains);
  const auto add = [&](const char* name, const char* unit, std::vector<double> values) {
    point.measured.push_back(measurement_of(group, name, unit, std::move(values)));
  };
  const double before = peak_memory_MB(), ns = 1e9 / point.grains;
  PreparedRun start = settled_start(deposited_box(scene, cache));
  scene.solver.threads = point.threads;
  std::vector<StepRecord> steps;
  TimeStepper stepper(start.system, scene, -1);
  // Steps with k < 0 warm up: caches fill.
  for (int k = -options.warm_up; k < options.steps; ++k) {
    const StepRecord step = stepper.step(start.state, start.memory);
    if (k >= 0) steps.push_back(step);
  }
  std::vector<double> whole;
  for (const StepRecord& step : steps) whole.push_back(ns * step_seconds(step));
  add("contacts", "contacts", record_column(steps, &StepRecord::contacts));
  add("iterations", "iterations", record_column(steps, &StepRecord::iterations));
  add("detect", "ns/grain", record_column(steps, &StepRecord::seconds_detect, ns));
  add("assemble", "ns/grain", record_column(steps, &StepRecord::seconds_assemble, ns));
  add("solve", "ns/grain", record_column(steps, &StepRecord::seconds_solve, ns));
  add("step", "ns/grain", std::move(whole));
  add("memory", "B/grain", {1048576.0 * (peak_memory_MB() - before) / point.grains});
}

/// Packs or unpacks the measurements that the child sends to the parent.
template <class Carrier, class List>
void carry(Carrier& carrier, List& measured) {
  carrier.list(measured, [&](auto& m) {
    for (auto* text : {&m.group, &m.name, &m.unit}) carrier.text(*text);
    carrier.numbers(m.median, m.mean, m.low, m.high, m.samples);
  });
}

}  // namespace

std::vector<Kernel> step_kernels(const DepositedBox& box, int steps) {
  const auto step = std::make_shared<StepWork>(box, steps);
  std::vector<Kernel> kernels;
  for (const bool use_cache : {false, true}) {
    const auto work = std::make_shared<DetectionWork>(step->start, box.scene.detection, use_cache);
    work->all();
    const double pairs = static_cast<double>(work->detector.counters().candidate_pairs);
    kernels.push_back({"detection", use_cache ? "axes kept" : "from scratch", "ns/pair",
                       std::max(1.0, pairs), [work] { work->all(); }});
  }
  const double contacts = std::max(1, step->assembler.problem().contact_count());
  const auto add = [&](const char* group, const std::string& name, std::function<void()> call) {
    kernels.push_back({group, name, "ns/contact", contacts, std::move(call)});
  };
  add("problem", "assembly", [step] { step->assemble(); });
  add("problem", "judge",
      [step] { step->judge.judge(step->assembler.problem(), step->stepper.impulses()); });
  for (const bool in_single : {false, true}) {
    const auto work = std::make_shared<SweepWork>(*step, in_single);
    const std::string how = in_single ? " in float lanes" : "";
    add("sweep", "sweep" + how, [work] { work->sweep->sweep(); });
    // The work of an iteration of nncg between two looks at the error.
    add("sweep", "sweep along a search" + how, [work] { work->sweep->sweep_along({0.1, 1.0}); });
    add("sweep", "error" + how, [work] { work->sweep->error(); });
  }
  return kernels;
}

std::vector<Measurement> run_kernels(const std::vector<Kernel>& kernels,
                                     const KernelBenchOptions& options) {
  std::vector<Measurement> measurements;
  for (const Kernel& kernel : kernels)
    if ((kernel.group + "/" + kernel.name).find(options.filter) != std::string::npos)
      measurements.push_back(
          measurement_of(kernel.group, kernel.name, kernel.unit, samples_of(kernel, options)));
  if (measurements.empty())
    throw std::invalid_argument("no kernel is called like '" + options.filter + "'");
  return measurements;
}

std::vector<BenchStep> measure_steps(Scene scene, PreparedRun start, long steps, int threads) {
  scene.solver.threads = threads;
  TimeStepper stepper(start.system, scene, start.system.first_driven_wall());
  std::vector<BenchStep> result;
  for (long k = 0; k < steps; ++k) {
    const double begin = processor_seconds();
    BenchStep step;
    step.record = stepper.step(start.state, start.memory);
    step.cpu_seconds = processor_seconds() - begin;
    step.counters = stepper.detection_counters();
    result.push_back(step);
  }
  return result;
}

std::vector<Measurement> step_measurements(const Scene& scene, const std::vector<BenchStep>& steps,
                                           int threads) {
  std::map<std::string, std::vector<const BenchStep*>> groups;
  double fastest = 0.0;
  for (const BenchStep& step : steps) fastest = std::max(fastest, std::abs(step.record.wall_v));
  for (const BenchStep& step : steps) {
    groups["all"].push_back(&step);
    groups[wall_state(step.record.wall_v, fastest)].push_back(&step);
  }
  std::vector<Measurement> result;
  for (const char* name : {"all", "passive", "jammed", "active"})
    add_group(thread_words(threads) + ", " + name, groups[name], velocity_scale(scene), result);
  return result;
}

double ScalingPoint::value(const std::string& name) const {
  const auto found = std::ranges::find(measured, name, &Measurement::name);
  return found == measured.end() ? not_known : found->median;
}

std::pair<int, int> tiles_for(long grains, int of_tile) {
  const double tiles = std::max(1.0, static_cast<double>(grains) / of_tile);
  const int nx = std::max(1, static_cast<int>(std::lround(std::sqrt(tiles))));
  return {nx, std::max(1, static_cast<int>(std::lround(tiles / nx)))};
}

void measure_scaling(const Scene& tile, const std::filesystem::path& cache,
                     const ScalingOptions& options,
                     const std::function<void(const ScalingPoint&)>& take) {
  require_backends(tile);  // here, for the exit code of one that is missing
  for (const int grains : options.grains)
    for (const int threads : options.threads) {
      const auto [nx, ny] = tiles_for(grains, tile.grains->count);
      Scene scene = tiled_scene(tile, nx, ny);
      scene.solver.threads = std::ranges::max(options.threads);  // while it is deposited
      ScalingPoint point{threads, nx, ny, static_cast<double>(scene.grains->count), {}};
      const auto in_child = [&](const std::function<std::string()>& work) {
        constexpr double day = 86400.0;  // [s]
        const ChildResult child = run_in_child(day, work);
        if (child.end == ChildEnd::complete) return child.answer;
        throw Error(printed("bench scaling: %.0f grains: ", point.grains) +
                    (child.end == ChildEnd::failed        ? child.answer
                     : child.end == ChildEnd::out_of_time ? "the child ran out of time"
                                                          : "the child died (out of memory?)"));
      };
      in_child([&] { return deposited_box(scene, cache).packing.key; });
      const std::string answer = in_child([&] {
        measure_packing(scene, cache, options, point);
        Packer packer;
        carry(packer, point.measured);
        return packer.bytes();
      });
      Unpacker unpacker(answer, "bench scaling: a child's answer");
      carry(unpacker, point.measured);
      unpacker.finish();
      take(point);
    }
}

Scene bench_scene(const std::string& name, const std::vector<std::string>& overrides) {
  Scene scene = resolve_run(name, overrides).scene;
  if (!scene.grains) throw Error(name + ": has no grains: a bench needs a deposited packing");
  return scene;
}

DepositedBox deposited_box(const Scene& scene, const std::filesystem::path& cache) {
  DepositedBox box{scene, make_rain(scene), {}};
  const InterruptGuard guard;
  const PackingOptions order{cache, [] { return !InterruptGuard::requested(); }};
  if (!load_or_deposit(box.scene, box.rain, order, box.packing))
    throw Error("interrupted; the same command goes on depositing");
  return box;
}

PreparedRun driven_start(const DepositedBox& box) {
  PreparedRun start;
  start.system = drive_system(box.scene, box.rain, box.packing, start.state);
  start.memory = box.packing.memory;
  return start;
}

PreparedRun settled_start(DepositedBox box) {
  PreparedRun start;
  start.system = box_system(box.scene, box.rain, BoxStage::settle, box.packing.deposit.lid);
  start.state = std::move(box.packing.state);
  start.memory = std::move(box.packing.memory);
  return start;
}

}  // namespace ballast
