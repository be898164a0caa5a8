// How fast: kernels, whole steps, scaling, cost against accuracy; and two results side by side.

#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

#include "experiments/bench/accuracy_bench.hpp"
#include "experiments/bench/kernels.hpp"
#include "experiments/bench/scaling_bench.hpp"
#include "experiments/bench/step_bench.hpp"
#include "experiments/commands/bench_help.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/compare/compare_options.hpp"
#include "platform/interrupt.hpp"
#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

struct BenchWords {
  std::string scene = "vibrated_box";
  std::vector<std::string> overrides;
  std::filesystem::path output = "results/bench", packing_cache = "results/packings";
  bool plot = true, cold_start = false;
  std::string threads = "1", grains = "1000,10000,100000", iterations = "20,50,100,200", solvers,
              tolerances = "1e-2,1e-3";
  long steps = 1000, warm_up = 5;
  double from = 0.0, duration = 0.01, tolerance = 1e-2;
  int max_iterations = 300;
  KernelBenchOptions kernels;
  std::filesystem::path a, b;
};
using Words = std::shared_ptr<BenchWords>;

/// Whatever is wrong with a list is said with its option's name.
template <typename Work>
auto usage(const char* option, const Work& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("bench: ") + option + ": " + error.what());
  } catch (const UnknownSolver& error) {
    throw UsageError(error.what());
  }
}

std::vector<int> ints_of(const char* option, const std::string& list, long most) {
  const std::vector<long> numbers = usage(option, [&] { return parse_counts(list, most); });
  return {numbers.begin(), numbers.end()};
}

void say(const std::string& text) { std::cout << text << std::flush; }

ExitCode finish(const BenchWords& words, const std::string& kind, const std::string& command,
                const MachineFacts& facts, const std::vector<Measurement>& measurements,
                const Figure* figure) {
  write_bench_result(words.output, kind, command, facts, measurements);
  std::string where =
      "\nresults in " + words.output.string() + ": " + kind + ".json, " + kind + ".csv";
  if (figure && words.plot && !gnuplot_version().empty()) {
    render_svg(*figure, words.output);
    where += ", " + figure->name + ".svg";
  }
  say(measurement_table(measurements) + where + "\n");
  return ExitCode::ok;
}

std::string command_of(const BenchWords& words, const std::string& rest) {
  std::string command = "ballast bench " + rest + " " + words.scene;
  for (const std::string& set : words.overrides) command += " --set '" + set + "'";
  return command;
}

ExitCode bench_kernels(const BenchWords& words) {
  if (!(words.kernels.min_time > 0.0)) throw UsageError("bench: --min-time: expected a number > 0");
  const DepositedBox box = deposited_box(words.scene, words.overrides, words.packing_cache);
  const MachineFacts facts = measure_machine();
  const KernelProblem problem = kernel_problem(box, 20);
  const auto measurements =
      usage("--filter", [&] { return run_kernels(problem, words.kernels, facts); });
  return finish(words, "kernels", command_of(words, "kernels"), facts, measurements, nullptr);
}

ExitCode bench_step(const BenchWords& words) {
  const std::vector<int> threads = ints_of("--threads", words.threads, 256);
  const DepositedBox box = deposited_box(words.scene, words.overrides, words.packing_cache);
  const MachineFacts facts = measure_machine();
  std::vector<Measurement> measurements;
  Figure figure;
  for (const int count : threads) {
    const std::vector<BenchStep> steps =
        measure_steps(box.scene, driven_start(box), words.steps, count);
    if (count == threads.front()) figure = step_figure(steps, 50);
    for (Measurement& m : step_measurements(box.scene, steps, count))
      measurements.push_back(std::move(m));
  }
  return finish(words, "step",
                command_of(words, "step --steps " + std::to_string(words.steps) + " --threads " +
                                      words.threads),
                facts, measurements, &figure);
}

ExitCode bench_scaling(const BenchWords& words) {
  ScalingOptions options;
  options.grains = usage("--grains", [&] { return parse_counts(words.grains, 100'000'000); });
  options.threads = ints_of("--threads", words.threads, 256);
  options.steps = static_cast<int>(words.steps);
  options.warm_up = static_cast<int>(words.warm_up);
  options.tolerance = words.tolerance;
  options.max_iterations = words.max_iterations;
  options.cold_start = words.cold_start;
  if (!(options.tolerance > 0.0)) throw UsageError("bench: --tolerance: expected a number > 0");
  options.solvers.clear();
  for (const ComparedSolver& solver :
       usage("--solvers", [&] { return parse_solvers(words.solvers); }))
    options.solvers.push_back(solver.name);
  const DepositedBox box = deposited_box(words.scene, words.overrides, words.packing_cache);
  const MachineFacts facts = measure_machine();
  const auto points = measure_scaling(box, options, [](const ScalingPoint& p) {
    std::cout << p.nx << " x " << p.ny << " copies, " << p.grains << " grains, " << p.threads
              << " threads: " << 1e-3 * p.step << " us a grain and step, " << p.bytes
              << " B a grain" << std::endl;
  });
  const Figure figure = scaling_figure(options, points);
  const std::string rest = printed(
      " --steps %ld --warm-up %ld --tolerance %g --max-iterations %d%s", words.steps, words.warm_up,
      words.tolerance, words.max_iterations, words.cold_start ? " --cold" : "");
  return finish(
      words, "scaling",
      command_of(words, "scaling --grains " + words.grains + " --threads " + words.threads + rest),
      facts, scaling_measurements(options, points), &figure);
}

ExitCode bench_accuracy(const BenchWords& words) {
  AccuracyOptions options;
  options.live.scene = words.scene;
  options.live.overrides = words.overrides;
  options.live.start = words.from;
  options.live.duration = words.duration;
  if (!(words.duration > 0.0)) throw UsageError("bench: --duration: expected a number > 0");
  if (!(words.from >= 0.0)) throw UsageError("bench: --from: expected a number >= 0");
  options.live.solvers = usage("--solvers", [&] { return parse_solvers(words.solvers); });
  options.live.tolerances.clear();
  if (words.tolerances != "none")
    options.live.tolerances =
        usage("--tolerances", [&] { return parse_tolerances(words.tolerances); });
  options.live.packing_cache = words.packing_cache;
  options.live.folder = words.output / "live";
  options.iterations = ints_of("--iterations", words.iterations, 1'000'000'000);
  const auto rows = measure_accuracy(options, [](const Trajectory& t) {
    std::cout << t.label() << ": " << t.steps.size() << " steps, " << t.ended << std::endl;
    return !InterruptGuard::requested();
  });
  const Figure figure = accuracy_figure(rows);
  const std::string window =
      printed("accuracy --from %g --duration %g", words.from, words.duration);
  const std::string limits = " --solvers " + words.solvers + " --tolerances " + words.tolerances +
                             " --iterations " + words.iterations;
  return finish(words, "accuracy", command_of(words, window + limits), measure_machine(),
                accuracy_measurements(rows), &figure);
}

ExitCode bench_diff(const BenchWords& words) {
  say(bench_ratio_table(read_bench_result(words.a), read_bench_result(words.b)));
  return ExitCode::ok;
}

/// A subcommand of bench that measures.
struct Measuring {
  const char* name;
  const char* about;
  const char* scene;  ///< the default
  ExitCode (*act)(const BenchWords&);
};

/// Adds one with what all that measure have.
CLI::App* add_measuring(CLI::App* bench, const Words& words, Action& action,
                        const Measuring& measuring) {
  CLI::App* command = bench->add_subcommand(measuring.name, measuring.about);
  command->add_option("scene", words->scene,
                      std::string("A scene with grains (") + measuring.scene + ")");
  command
      ->add_option("--set", words->overrides, "Overrides one value of the scene: dotted.key=value")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  command->add_option("--packing-cache", words->packing_cache, "Where deposited packings are kept")
      ->capture_default_str()
      ->type_name("DIR");
  command->add_option("--output", words->output, "Folder of the results")
      ->capture_default_str()
      ->type_name("DIR");
  command->add_flag_callback(
      "--no-plot", [words] { words->plot = false; }, "No figure");
  command->callback([words, &action, measuring, command] {
    if (command->count("scene") == 0) words->scene = measuring.scene;
    action = [words, act = measuring.act] { return act(*words); };
  });
  return command;
}

const CLI::Range positive(1L, 1'000'000'000L);

void add_kernels(CLI::App* bench, Action& action) {
  const auto words = std::make_shared<BenchWords>();
  CLI::App* command =
      add_measuring(bench, words, action,
                    {"kernels", "The inner loops on their own, beside the machine's limits",
                     "vibrated_box_small", bench_kernels});
  command->add_option("--filter", words->kernels.filter, "Regular expression over group/name");
  command->add_option("--min-time", words->kernels.min_time, "CPU seconds of a repetition")
      ->capture_default_str();
  command->add_option("--repeats", words->kernels.repeats, "Repetitions")
      ->capture_default_str()
      ->check(positive);
  command->add_option("--streaming-MB", words->kernels.streaming_MB,
                      "Least records of the streaming sweep (0: twice the last cache)");
}

void add_step(CLI::App* bench, Action& action) {
  const auto words = std::make_shared<BenchWords>();
  CLI::App* command =
      add_measuring(bench, words, action,
                    {"step", "Whole steps by phase, from the deposited packing driven",
                     "vibrated_box", bench_step});
  command->add_option("--steps", words->steps, "Steps")->capture_default_str()->check(positive);
  command->add_option("--threads", words->threads, "Threads of the solver, separated by commas")
      ->capture_default_str();
}

void add_scaling(CLI::App* bench, Action& action) {
  const auto words = std::make_shared<BenchWords>();
  words->steps = 10;
  words->solvers = "pgs,nncg";
  CLI::App* command = add_measuring(
      bench, words, action,
      {"scaling", "Cost per grain of growing packings: copies of the deposited one side by side",
       "vibrated_box", bench_scaling});
  command
      ->add_option("--grains", words->grains,
                   "Grains, separated by commas: each the nearest number of copies")
      ->capture_default_str();
  command->add_option("--threads", words->threads, "Threads of the solver, separated by commas")
      ->capture_default_str();
  command->add_option("--steps", words->steps, "Measured steps")
      ->capture_default_str()
      ->check(positive);
  command->add_option("--warm-up", words->warm_up, "Steps before them")
      ->capture_default_str()
      ->check(positive);
  command->add_option("--solvers", words->solvers, "Whose iterations are counted")
      ->capture_default_str();
  command->add_option("--tolerance", words->tolerance, "To this error [g h]")
      ->capture_default_str();
  command->add_flag("--cold", words->cold_start, "From no impulses, not from the last step's");
  command->add_option("--max-iterations", words->max_iterations, "At most so many")
      ->capture_default_str()
      ->check(positive);
}

void add_accuracy(CLI::App* bench, Action& action) {
  const auto words = std::make_shared<BenchWords>();
  words->solvers = "nncg,pgs,anderson_pgs,apgd";
  CLI::App* command = add_measuring(
      bench, words, action,
      {"accuracy", "What a simulated second costs at which error", "vibrated_box", bench_accuracy});
  command->add_option("--solvers", words->solvers, "Separated by commas")->capture_default_str();
  command->add_option("--tolerances", words->tolerances, "Solved to these [g h]; none: not")
      ->capture_default_str();
  command
      ->add_option("--iterations", words->iterations, "And with so many iterations in every step")
      ->capture_default_str();
  command->add_option("--from", words->from, "Simulated time where all begin [s]")
      ->capture_default_str();
  command->add_option("--duration", words->duration, "Simulated from there [s]")
      ->capture_default_str();
}

void add_diff(CLI::App* bench, Action& action) {
  const auto words = std::make_shared<BenchWords>();
  CLI::App* command = bench->add_subcommand("diff", "Two result files as a ratio table (Markdown)");
  command->add_option("A", words->a, "A .json of ballast bench")->required();
  command->add_option("B", words->b, "Another of the same kind")->required();
  command->callback([words, &action] { action = [words] { return bench_diff(*words); }; });
}

}  // namespace

void add_bench_command(CLI::App& program, Action& action) {
  CLI::App* bench = program.add_subcommand(
      "bench", "How fast: kernels, whole steps, scaling, cost against accuracy");
  bench->require_subcommand(1);
  bench->footer(bench_footer);
  for (const auto add : {add_kernels, add_step, add_scaling, add_accuracy, add_diff})
    add(bench, action);
}

}  // namespace ballast
