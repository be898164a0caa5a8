// Backends on identical problems: rows, figures and a page.

#include <CLI/CLI.hpp>

#include <cmath>
#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/compare/backend_summary.hpp"
#include "experiments/compare/compare_options.hpp"
#include "experiments/compare/compare_page.hpp"
#include "experiments/compare/live_page.hpp"
#include "experiments/compare/reference_times.hpp"
#include "experiments/run/manifest.hpp"
#include "experiments/run_page/report_origin.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/program.hpp"
#include "platform/text.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

struct CompareWords {
  LiveOptions live;
  std::vector<std::string> cases;
  std::string solvers = "all", tolerances = "1e-4,1e-8", starts = "cold", measure = "natural_map";
  std::filesystem::path output = "results/compare", reference;
  CompareOptions comparison;
  bool report = true;
};

bool show(const CompareRow& row, bool was_there, size_t done, size_t count) {
  std::cout << printed("%5zu/%zu  %-34.34s %-14s %-6g %-4s %-13s %10.4g s  error %9.3g%s%s", done,
                       count, row.case_name.c_str(), row.solver.c_str(), row.tolerance,
                       name_of(row.start), name_of(row.outcome), row.seconds(), row.error,
                       was_there ? "  (was there)" : "",
                       row.is_false_success() ? "  JUDGE DISAGREES" : "")
            << std::endl;
  return !InterruptGuard::requested();
}

/// What is wrong with the words; std::invalid_argument from the parsers gets its option's name
/// here.
void parse(CompareWords& options) {
  const auto with_name = [](const char* option, const auto& work) {
    try {
      work();
    } catch (const std::invalid_argument& error) {
      throw UsageError(std::string("compare: ") + option + ": " + error.what());
    } catch (const UnknownSolver& error) {
      throw UsageError(error.what());
    }
  };
  CompareOptions& comparison = options.comparison;
  with_name("--solvers", [&] { comparison.solvers = parse_solvers(options.solvers); });
  with_name("--tolerances", [&] { comparison.tolerances = parse_tolerances(options.tolerances); });
  with_name("--starts", [&] { comparison.starts = parse_starts(options.starts); });
  with_name("--measure", [&] { comparison.measure = measure_of(options.measure); });
  if (options.cases.empty() == options.live.scene.empty())
    throw UsageError("compare: expected cases, or --live SCENE");
  if (!(options.live.start >= 0.0)) throw UsageError("compare: --from: expected a number >= 0");
  if (!(options.live.duration > 0.0))
    throw UsageError("compare: --duration: expected a number > 0");
  if (!(options.live.trajectory_seconds > 0.0))
    throw UsageError("compare: --trajectory-seconds: expected a number > 0");
  if (comparison.repeats < 1) throw UsageError("compare: --repeats: expected a number >= 1");
  if (!(comparison.max_seconds > 0.0))
    throw UsageError("compare: --max-seconds: expected a number > 0");
  if (!(comparison.limits.memory_MB >= 0.0))
    throw UsageError("compare: --memory: expected a number >= 0");
}

ExitCode interrupted() {
  std::cerr << "ballast: compare: interrupted; nothing is lost, the same command goes on"
            << std::endl;
  return ExitCode::failure;
}

bool show_trajectory(const Trajectory& trajectory) {
  std::cout << trajectory.label() << ": " << trajectory.steps.size() << " steps, "
            << trajectory.ended << std::endl;
  return !InterruptGuard::requested();
}

/// The closed loop under each backend.
ExitCode compare_live(const CompareWords& options) {
  LiveOptions live = options.live;
  live.solvers = options.comparison.solvers;
  live.tolerances = options.comparison.tolerances;
  live.max_seconds = options.comparison.max_seconds;
  live.folder = options.output;
  const LiveComparison comparison = run_live(live, show_trajectory);
  if (InterruptGuard::requested()) return interrupted();
  Manifest manifest("compare --live " + live.scene, {options.comparison.command}, binary_key());
  manifest.summary("blas", loaded_blas());
  manifest.write(options.output / "manifest.json");
  write_live_page(options.output, comparison);
  std::cout << "\nresults in " << options.output.string()
            << "\n  live.html   figures and the table: open it in a browser\n"
            << "  live.csv    one row per trajectory; steps-*.csv: every step's scalars"
            << std::endl;
  return ExitCode::ok;
}

ExitCode compare(CompareWords options) {
  parse(options);
  restart_with_one_algebra_thread();
  const std::vector<std::string> words = own_words();
  options.comparison.folder = options.output;
  for (const std::string& word : words)
    options.comparison.command += (options.comparison.command.empty() ? "" : " ") +
                                  shell_word(&word == &words[0] ? "ballast" : word);
  if (!options.live.scene.empty()) return compare_live(options);
  std::vector<ReferenceTimes> reference;
  if (!options.reference.empty()) reference = read_reference_times(options.reference);
  const std::vector<CompareCase> cases = compare_cases(options.cases);
  InterruptGuard guard;
  const std::vector<CompareRow> rows = run_comparison(cases, options.comparison, show);
  if (InterruptGuard::requested()) return interrupted();
  if (options.report) write_compare_page(options.output, rows, reference);
  std::cout << '\n'
            << compare_summary(rows, reference) << "\nresults in " << options.output.string()
            << "\n"
            << (options.report ? "  compare.html  figures and tables: open it in a browser\n" : "")
            << "  results.csv   one row per solve; rows/*.json: the same with their histories\n"
            << "  manifest.json program, machine, BLAS, options" << std::endl;
  return ExitCode::ok;
}

constexpr const char* compare_footer =
    R"(Cases are files (.hdf5, .h5, .dat), folders, patterns, and problems made on the spot:
  known:bodies=20,contacts=40,seed=1,count=3
                                   problems with a known solution; also copies=1, mass_ratio=1e3,
                                   friction_min=0, friction_max=1, open=.25, slip=.35,
                                   frictionless=.1
  stress:all                       the small ones that break solvers
  stress:stack,n=2,ratio=1e6       n boxes, the uppermost of so many times the others' mass
                                   (rows=1: without friction)
  stress:chain,grains=50,force=1e4 grains jammed between walls
  stress:table,copies=25,mu=.5,speed=.01

Each solve runs in a child process under limits of time and memory; a timeout or a crash is a row.
A solve shorter than a quarter of a second is repeated in its child, and the fastest run counts.
"solved": the backend says so and the judge, outside the child, agrees.

The tolerance bounds, by --measure
  natural_map   the judge's scaled natural map, rms over contacts, relative to the rms of q, or to
                g h for captured problems
  fclib         what Siconos prints: natural map with rho = 1 over max(|q|, |r|, |u|). Backends
                stop on the natural map, so its tolerance falls in rounds, each from the last one's
                impulses, until the judge is satisfied; the rounds' times are added

What is in the output folder is kept: the same command goes on after an interrupt; rows made by
another binary are made again.

Examples:
  ballast compare my_problems --measure fclib --reference times_of_another.csv
  ballast compare results/captured/capture --solvers pgs,nncg,admm --starts cold,warm \
    --tolerances 1e-3,1e-4,1e-6
  ballast compare known:contacts=200,count=5 --repeats 5
  ballast compare --live vibrated_box --from 0.25 --duration 0.02 --solvers pgs,nncg \
    --tolerances 1e-2,1e-3,1e-4)";

}  // namespace

void add_compare_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand(
      "compare", "Backends on identical problems: accuracy against cost, figures, a page");
  auto options = std::make_shared<CompareWords>();
  CompareOptions& comparison = options->comparison;
  command->add_option("cases", options->cases,
                      "Problem files, folders, patterns, known:..., stress:...");
  command->add_option("--solvers", options->solvers, "Names, separated by commas, or all")
      ->capture_default_str();
  command->add_option("--tolerances", options->tolerances, "Separated by commas")
      ->capture_default_str();
  command
      ->add_option("--starts", options->starts,
                   "cold, warm or cold,warm; warm where a case has a warm start")
      ->capture_default_str();
  command->add_option("--measure", options->measure, "natural_map or fclib")->capture_default_str();
  command->add_option("--repeats", comparison.repeats, "Interleaved; tables show the median")
      ->capture_default_str();
  command
      ->add_option("--max-seconds", comparison.max_seconds,
                   "Wall clock of one solve, prepare included")
      ->capture_default_str();
  command
      ->add_option("--memory", comparison.limits.memory_MB,
                   "Address space of one child in MB; 0: no limit")
      ->capture_default_str();
  command
      ->add_option("--reference", options->reference,
                   "CSV of others' times: problem,ms_1e-4,solver_1e-4,...")
      ->type_name("FILE");
  command->add_option("--output", options->output, "Folder of the results")
      ->capture_default_str()
      ->type_name("DIR");
  command->add_flag_callback(
      "--no-report", [options] { options->report = false; }, "No figures and no page");
  LiveOptions& live = options->live;
  command
      ->add_option(
          "--live", live.scene,
          "Instead of cases: a scene's closed loop from one start under each backend and tolerance")
      ->type_name("SCENE");
  command->add_option("--set", live.overrides, "Of that scene: dotted.key=value")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  command->add_option("--from", live.start,
                      "Simulated time up to which the scene's own solver goes, once for all [s]");
  command->add_option("--duration", live.duration, "Simulated from there under each backend [s]")
      ->capture_default_str();
  command
      ->add_option("--trajectory-seconds", live.trajectory_seconds, "Wall clock of one trajectory")
      ->capture_default_str();
  command
      ->add_option("--packing-cache", live.packing_cache,
                   "Where deposited packings are kept (<output>/packings)")
      ->type_name("DIR");
  command->footer(compare_footer);
  command->callback([options, &action] { action = [options] { return compare(*options); }; });
}

}  // namespace ballast
