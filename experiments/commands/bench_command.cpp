// The command bench: times kernels, whole steps and scaling, and compares two results.

#include <iostream>
#include <memory>

#include "experiments/bench/step_bench.hpp"
#include "experiments/commands/command.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"

namespace ballast {

namespace {

/// The values of the command lines; each subcommand has some of them.
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

/// Checks the folder before hours of measuring: results of several kinds may share one.
void require_own_results(const BenchRequest& request, const std::string& kind) {
  const std::filesystem::path file = request.output / (kind + ".json");
  if (path_exists(file)) read_bench_result(file);  // throws where it is none of ours
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
  Measurements measurements;
  measure_scaling(tile, request.packing_cache, request.scaling, [&](const ScalingPoint& p) {
    std::cout << p.nx << " x " << p.ny << " tiles, " << p.grains << " grains, " << p.threads
              << " threads: " << 1e-3 * p.value("step") << " us a grain and step, "
              << p.value("memory") << " B a grain" << std::endl;
    measurements.insert(measurements.end(), p.measured.begin(), p.measured.end());
  });
  return measurements;
}

/// A subcommand that measures on a scene: it has the words common to all of them, then `more`.
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
  return measuring("kernels", "Times each inner loop of a step alone", request, bench_kernels,
                   {{"--filter", &kernels.filter, "Times kernels with this text in group/name"},
                    {"--min-time", &kernels.min_time, "CPU time of one repetition [s]", above(0)},
                    {"--repeats", &kernels.repeats, "Timed repetitions", between(1, most_count)}});
}

Command step_command() {
  const auto request = std::make_shared<BenchRequest>();
  return measuring(
      "step", "Times whole steps of the driven box by phase, from its packing", request, bench_step,
      {{"--steps", &request->steps, "Measured steps", between(1, most_count)},
       {"--threads", &request->threads, "Numbers of threads, comma-separated", between(1, 256)}});
}

Command scaling_command() {
  const auto request = std::make_shared<BenchRequest>();
  ScalingOptions& scaling = request->scaling;
  scaling.grains = {1000, 10000, 100000};
  constexpr int most_grains = most_count / 10;
  return measuring(
      "scaling", "Measures time and memory per grain of growing boxes of one shape", request,
      bench_scaling,
      {{"--grains", &scaling.grains,
        "Numbers of grains, comma-separated, rounded to multiples of the scene's",
        between(1, most_grains)},
       {"--threads", &scaling.threads, "Numbers of threads, comma-separated", between(1, 256)},
       {"--steps", &scaling.steps, "Measured steps", between(1, most_count)},
       {"--warm-up", &scaling.warm_up, "Steps before the measured ones", between(1, most_count)}});
}

Command all_command() {
  const auto all = std::make_shared<BenchAll>();
  return {"all",
          "Measures the numbers of docs/results.md and writes the page as results.md; takes hours",
          {{"--output DIR", &all->output, "Folder of the results"},
           {"--beside COMMAND", &all->beside,
            "Command that prints another program's step time [ms] last; run in turn with ours"},
           {"--page FILE", &all->page, "Your own page, written like experiments/bench/results.md"},
           {"--rows FILE", &all->rows, "Writes the page from this numbers.csv; measures nothing"}},
          [all] { return bench_all(*all); }};
}

Command diff_command() {
  struct Files {
    std::filesystem::path a, b;
  };
  const auto files = std::make_shared<Files>();
  return {"diff",
          "Prints a Markdown table of the ratios B/A of two result files",
          {{"A", &files->a, "A result of ballast bench (.json)", required},
           {"B", &files->b, "Another result of the same kind", required}},
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
          "Measures speed: kernels, whole steps, scaling with size",
          {},
          {},
          {kernels_command(), step_command(), scaling_command(), all_command(), diff_command()}};
}

}  // namespace ballast
