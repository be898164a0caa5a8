// How fast: kernels, whole steps, scaling; and two results side by side.

#include <iostream>
#include <memory>

#include "experiments/bench/step_bench.hpp"
#include "experiments/commands/command.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {

namespace {

/// What is on the command lines; each subcommand has some of it.
struct BenchRequest {
  std::string scene = "vibrated_box";
  std::vector<std::string> overrides;  ///< "dotted.key=value"
  std::filesystem::path packing_cache = "results/packings", output = "results/bench";
  KernelBenchOptions kernels;
  int steps = 1000;
  std::vector<int> threads{1};
  ScalingOptions scaling;

  DepositedBox box() const { return deposited_box(bench_scene(scene, overrides), packing_cache); }
};

constexpr int most_count = 1'000'000'000;  // of steps, repetitions

void say(const std::string& text) { std::cout << text << std::flush; }

/// Before hours of measuring: results of several kinds may share a folder.
void require_own_results(const BenchRequest& request, const std::string& kind) {
  const std::filesystem::path file = request.output / (kind + ".json");
  if (is_there(file)) read_bench_result(file);  // says so where it is somebody's
  constexpr const char* ours = "\"measurements\": [";
  require_own_folder(
      request.output,
      {{"kernels.json", ours}, {"step.json", ours}, {"scaling.json", ours}, "packings"});
}

using Measurements = std::vector<Measurement>;

Measurements bench_kernels(const BenchRequest& request) {
  const DepositedBox box = request.box();
  try {
    return run_kernels(step_kernels(box, 20), request.kernels);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("bench: --filter: ") + error.what());
  }
}

Measurements bench_step(const BenchRequest& request) {
  const DepositedBox box = request.box();
  Measurements measurements;
  for (const int threads : request.threads) {
    const std::vector<BenchStep> steps =
        measure_steps(box.scene, driven_start(box), request.steps, threads);
    for (Measurement& m : step_measurements(box.scene, steps, threads))
      measurements.push_back(std::move(m));
  }
  return measurements;
}

Measurements bench_scaling(const BenchRequest& request) {
  const Scene tile = bench_scene(request.scene, request.overrides);
  const auto said = [](const ScalingPoint& p) {
    std::cout << p.nx << " x " << p.ny << " tiles, " << p.grains << " grains, " << p.threads
              << " threads: " << 1e-3 * p.value("step") << " us a grain and step, "
              << p.value("memory") << " B a grain" << std::endl;
  };
  const auto points = measure_scaling(tile, request.packing_cache, request.scaling, said);
  Measurements measurements;
  for (const ScalingPoint& p : points)
    measurements.insert(measurements.end(), p.measured.begin(), p.measured.end());
  return measurements;
}

/// A subcommand that measures on a scene: what all of them have, then `more`.
Command measuring(const char* name, const char* meaning,
                  const std::shared_ptr<BenchRequest>& request,
                  Measurements (*measure)(const BenchRequest&), const std::vector<Word>& more) {
  std::vector<Word> words{
      {"scene", &request->scene, "A scene with grains"},
      {"--set KEY=VALUE", &request->overrides,
       "Overrides one value of the scene: dotted.key=value"},
      {"--packing-cache DIR", &request->packing_cache, "Where deposited packings are kept"},
      {"--output DIR", &request->output, "Folder of the results"}};
  words.insert(words.end(), more.begin(), more.end());
  return {name, meaning, words, [=] {
            require_own_results(*request, name);
            const Measurements measurements = measure(*request);
            write_bench_result(request->output, name, own_command(), measurements);
            say(measurement_table(measurements) + "\nresults in " + request->output.string() +
                ": " + name + ".json\n");
            return ExitCode::ok;
          }};
}

Command kernels_command() {
  const auto request = std::make_shared<BenchRequest>();
  request->scene = "vibrated_box_small";
  KernelBenchOptions& kernels = request->kernels;
  return measuring("kernels", "The inner loops of a step on their own", request, bench_kernels,
                   {{"--filter", &kernels.filter, "A part of group/name"},
                    {"--min-time", &kernels.min_time, "CPU seconds of a repetition", above(0)},
                    {"--repeats", &kernels.repeats, "Repetitions", between(1, most_count)}});
}

Command step_command() {
  const auto request = std::make_shared<BenchRequest>();
  return measuring("step", "Whole steps by phase, from the deposited packing driven", request,
                   bench_step,
                   {{"--steps", &request->steps, "Steps", between(1, most_count)},
                    {"--threads", &request->threads, "Threads of a step, separated by commas",
                     between(1, 256)}});
}

Command scaling_command() {
  const auto request = std::make_shared<BenchRequest>();
  ScalingOptions& scaling = request->scaling;
  scaling.grains = {1000, 10000, 100000};
  constexpr int most_grains = most_count / 10;
  return measuring(
      "scaling", "Cost per grain of growing boxes of one shape, settled from tiles", request,
      bench_scaling,
      {{"--grains", &scaling.grains,
        "Grains, separated by commas: each the nearest number of tiles", between(1, most_grains)},
       {"--threads", &scaling.threads, "Threads of a step, separated by commas", between(1, 256)},
       {"--steps", &scaling.steps, "Measured steps", between(1, most_count)},
       {"--warm-up", &scaling.warm_up, "Steps before them", between(1, most_count)}});
}

Command all_command() {
  const auto all = std::make_shared<BenchAll>();
  return {"all",
          "Everything on the page of results, by its own commands, and the page anew: hours",
          {{"--output DIR", &all->output, "Folder of the results"},
           {"--beside COMMAND", &all->beside,
            "Another program's step, by turns with ours: its last word is milliseconds"},
           {"--page FILE", &all->page, "A page of yours, written as experiments/bench/results.md"},
           {"--rows FILE", &all->rows, "The page of these numbers.csv; nothing is measured"}},
          [all] { return bench_all(*all); }};
}

Command diff_command() {
  struct Files {
    std::filesystem::path a, b;
  };
  const auto files = std::make_shared<Files>();
  return {"diff",
          "Two result files as a ratio table (Markdown)",
          {{"A", &files->a, "A .json of ballast bench", required},
           {"B", &files->b, "Another of the same kind", required}},
          [files] {
            const BenchResult a = read_bench_result(files->a), b = read_bench_result(files->b);
            if (a.kind != b.kind)
              throw Error(files->b.string() + ": kind = \"" + b.kind + "\", expected \"" + a.kind +
                          "\" as of " + files->a.string());
            say(bench_ratio_table(a, b));
            return ExitCode::ok;
          }};
}

}  // namespace

Command bench_command() {
  return {"bench",
          "How fast: kernels, whole steps, scaling",
          {},
          {},
          {kernels_command(), step_command(), scaling_command(), all_command(), diff_command()}};
}

}  // namespace ballast
