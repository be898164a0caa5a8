// How fast: kernels, whole steps, scaling, cost against accuracy; and two results side by side.

#include <iostream>
#include <memory>

#include "experiments/bench/accuracy_bench.hpp"
#include "experiments/bench/bench_page.hpp"
#include "experiments/bench/step_bench.hpp"
#include "experiments/commands/command.hpp"
#include "experiments/compare/comparison.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"

namespace ballast {

namespace {

/// What is on the command lines; each subcommand has some of it.
struct BenchRequest {
  std::vector<std::string> problems;
  LiveOptions live;  ///< and the scene that all others measure on
  std::filesystem::path output = "results/bench";
  bool plot = true;
  KernelBenchOptions kernels;
  int steps = 1000;
  std::vector<int> threads{1};
  ScalingOptions scaling;
  CompareOptions captured;

  DepositedBox box() const { return deposited_box(live.scene, live.overrides, live.packing_cache); }
};

constexpr int most_count = 1'000'000'000;  // of steps, iterations, repetitions

std::vector<std::string> solver_names(const std::string& list) {
  std::vector<std::string> names;
  for (const ComparedSolver& solver : parse_solvers(list)) names.push_back(solver.name);
  return names;
}
std::vector<double> tolerances_or_none(const std::string& list) {
  return list == "none" ? std::vector<double>{} : parse_tolerances(list);
}

void say(const std::string& text) { std::cout << text << std::flush; }

/// Before hours of measuring: results of several kinds may share a folder.
void require_own_results(const BenchRequest& request, const std::string& kind) {
  const std::filesystem::path file = request.output / (kind + ".json");
  if (is_there(file)) read_bench_result(file);  // says so where it is somebody's
  constexpr const char* ours = "\"measurements\": [";
  require_own_folder(request.output, {{"kernels.json", ours},
                                      {"step.json", ours},
                                      {"scaling.json", ours},
                                      {"accuracy.json", ours},
                                      {"captured.json", ours},
                                      "packings",
                                      "live",
                                      "rows",
                                      "exact"});
}

ExitCode finish(const BenchRequest& request, const std::string& kind,
                const std::vector<Measurement>& measurements, const Figure* figure) {
  write_bench_result(request.output, kind, own_command(), measurements);
  std::string where = "\nresults in " + request.output.string() + ": " + kind + ".json";
  if (figure && request.plot && !gnuplot_version().empty()) {
    render_svg(*figure, request.output);
    where += ", " + figure->name + ".svg";
  }
  say(measurement_table(measurements) + where + "\n");
  return ExitCode::ok;
}

ExitCode bench_kernels(const BenchRequest& request) {
  const DepositedBox box = request.box();
  try {
    return finish(request, "kernels", run_kernels(step_kernels(box, 20), request.kernels), nullptr);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("bench: --filter: ") + error.what());
  }
}

ExitCode bench_step(const BenchRequest& request) {
  const DepositedBox box = request.box();
  std::vector<Measurement> measurements;
  Figure figure;
  for (const int threads : request.threads) {
    const std::vector<BenchStep> steps =
        measure_steps(box.scene, driven_start(box), request.steps, threads);
    if (threads == request.threads.front()) figure = step_figure(steps, 50);
    for (Measurement& m : step_measurements(box.scene, steps, threads))
      measurements.push_back(std::move(m));
  }
  return finish(request, "step", measurements, &figure);
}

ExitCode bench_scaling(const BenchRequest& request) {
  const DepositedBox box = request.box();
  const auto points = measure_scaling(box, request.scaling, [](const ScalingPoint& p) {
    std::cout << p.nx << " x " << p.ny << " copies, " << p.grains << " grains, " << p.threads
              << " threads: " << 1e-3 * p.value("step") << " us a grain and step, "
              << p.value("memory") << " B a grain" << std::endl;
  });
  std::vector<Measurement> measurements;
  for (const ScalingPoint& p : points)
    measurements.insert(measurements.end(), p.measured.begin(), p.measured.end());
  const Figure figure = scaling_figure(request.scaling, points);
  return finish(request, "scaling", measurements, &figure);
}

ExitCode bench_accuracy(const BenchRequest& request) {
  LiveOptions live = request.live;
  live.folder = request.output / "live";
  const LiveComparison comparison = measure_accuracy(live, [](const Trajectory& t) {
    std::cout << t.label() << ": " << t.steps.size() << " steps, " << t.ended << std::endl;
    return !InterruptGuard::requested();
  });
  const Figure figure = accuracy_figure(comparison);
  return finish(request, "accuracy", accuracy_measurements(comparison), &figure);
}

ExitCode bench_captured(const BenchRequest& request) {
  require_own_results(request, "captured");
  restart_with_one_algebra_thread();
  CompareOptions options = request.captured;
  options.folder = request.output;
  options.command = own_command();
  const InterruptGuard guard;
  const auto said = [](const CompareRow& r, bool, size_t, size_t) {
    say(printed("%-24s %-13s %-4s %-6g %-8s %8.3f s  error %8.2e  velocities %8.2e\n",
                r.case_name.c_str(), r.solver.c_str(), name_of(r.start), r.tolerance,
                name_of(r.verdict), r.seconds(), r.error, r.distance.velocity));
    return !InterruptGuard::requested();
  };
  const auto rows = run_comparison(compare_cases(request.problems), options, said);
  const Figure figure = captured_figure(rows);
  return finish(request, "captured", captured_measurements(rows),
                figure.panels.empty() ? nullptr : &figure);
}

/// A subcommand that measures on a scene: what all of them have, then `more`.
Command measuring(const char* name, const char* meaning,
                  const std::shared_ptr<BenchRequest>& request,
                  ExitCode (*act)(const BenchRequest&), const std::vector<Word>& more) {
  LiveOptions& live = request->live;
  if (live.scene.empty()) live.scene = "vibrated_box";
  live.packing_cache = "results/packings";
  std::vector<Word> words{
      {"scene", &live.scene, "A scene with grains"},
      {"--set KEY=VALUE", &live.overrides, "Overrides one value of the scene: dotted.key=value"},
      {"--packing-cache DIR", &live.packing_cache, "Where deposited packings are kept"},
      {"--output DIR", &request->output, "Folder of the results"},
      {"--no-plot", &request->plot, "No figure"}};
  words.insert(words.end(), more.begin(), more.end());
  return {name, meaning, words, [=] {
            require_own_results(*request, name);
            return act(*request);
          }};
}

Command kernels_command() {
  const auto request = std::make_shared<BenchRequest>();
  request->live.scene = "vibrated_box_small";
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
                    {"--threads", &request->threads, "Threads of the solver, separated by commas",
                     between(1, 256)}});
}

Command scaling_command() {
  const auto request = std::make_shared<BenchRequest>();
  ScalingOptions& scaling = request->scaling;
  scaling.grains = {1000, 10000, 100000};
  constexpr int most_grains = most_count / 10;
  return measuring(
      "scaling", "Cost per grain of growing packings: copies of the deposited one side by side",
      request, bench_scaling,
      {{"--grains", &scaling.grains,
        "Grains, separated by commas: each the nearest number of copies", between(1, most_grains)},
       {"--threads", &scaling.threads, "Threads of the solver, separated by commas",
        between(1, 256)},
       {"--steps", &scaling.steps, "Measured steps", between(1, most_count)},
       {"--warm-up", &scaling.warm_up, "Steps before them", between(1, most_count)},
       {"--solvers", into(scaling.solvers, solver_names, "pgs,nncg"),
        "Whose iterations are counted"},
       {"--tolerance", &scaling.tolerance, "To this error [g h]", above(0)},
       {"--max-iterations", &scaling.max_iterations, "At most so many", between(1, most_count)}});
}

Command accuracy_command() {
  const auto request = std::make_shared<BenchRequest>();
  LiveOptions& live = request->live;
  live.duration = 0.01;
  live.iterations = {20, 50, 100, 200};
  return measuring("accuracy", "What a simulated second costs at which error", request,
                   bench_accuracy,
                   {{"--solvers", into(live.solvers, parse_solvers, "nesterov_pgs,nncg,pgs,apgd"),
                     "Separated by commas"},
                    {"--tolerances", into(live.tolerances, tolerances_or_none, "1e-2,1e-3"),
                     "Solved to these [g h]; none: not"},
                    {"--iterations", &live.iterations, "And with so many iterations in every step",
                     between(1, most_count)},
                    {"--threads", &live.threads, "Of the step and its solver", between(1, 256)},
                    {"--from", &live.start, "Simulated time where all begin [s]", at_least(0)},
                    {"--duration", &live.duration, "Simulated from there [s]", above(0)}});
}

Command captured_command() {
  const auto request = std::make_shared<BenchRequest>();
  CompareOptions& captured = request->captured;
  captured.max_seconds = 5.0;
  captured.exact_seconds = 60.0;
  return {"captured",
          "Every measure of an answer's error against its cost, on problems of a run",
          {{"problems", &request->problems, "Files, folders, patterns (ballast run --capture)",
            required},
           {"--solvers", into(captured.solvers, parse_solvers, "nesterov_pgs,newton_burst"),
            "Separated by commas"},
           {"--tolerances", into(captured.tolerances, parse_tolerances, "1e-1,1e-2,1e-3,1e-4,1e-6"),
            "Solved to these [g h]"},
           {"--starts", into(captured.starts, parse_starts, "warm"), "cold, warm or cold,warm"},
           {"--max-seconds", &captured.max_seconds, "Of one solve", above(0)},
           {"--exact-seconds", &captured.exact_seconds,
            "Spent on a solution at 1e-9 of each problem, from which distances are measured; 0: "
            "none",
            at_least(0)},
           {"--output DIR", &request->output, "Folder of the results"},
           {"--no-plot", &request->plot, "No figure"}},
          [request] { return bench_captured(*request); }};
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
          "How fast: kernels, whole steps, scaling, cost against accuracy",
          {},
          {},
          {kernels_command(), step_command(), scaling_command(), accuracy_command(),
           captured_command(), all_command(), diff_command()}};
}

}  // namespace ballast
