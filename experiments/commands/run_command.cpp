#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/run/capture.hpp"
#include "experiments/run/run.hpp"
#include "experiments/run_page/report.hpp"
#include "experiments/run_page/report_origin.hpp"

namespace ballast {

namespace {

void check_capture(const std::string& text) {
  try {
    CaptureSettings::parse(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("run: --capture: ") + error.what());
  }
}

/// Draws the run's page where it is asked for or missing, and says what is where and what can be
/// done next.
void show_results(const RunEnd& end, const RunOptions& options, bool with_page) {
  const bool has_page = std::filesystem::exists(end.folder / "report.html");
  if (with_page && (!end.was_finished || !has_page)) write_report(end.folder);
  if (end.was_finished) return;
  std::cout << "\nresults in " << end.folder.string() << "\n";
  if (with_page)
    std::cout << "  report.html   figures and the table of the run: open it in a browser\n";
  std::cout << "  steps.csv     every step's scalars\n"
            << "  record.h5     the same and the poses (HDF5)\n";
  if (!options.capture.empty())
    std::cout << "  capture/      friction problems of steps, for ballast compare\n";
  std::cout << "  manifest.json machine, commit, parameters, summary\n\nwhat next\n"
            << next_commands(end.has_grains) << std::flush;
}

/// What happens beside the run itself. `options` must live as long as the command.
void add_packing_and_limits(CLI::App& command, RunOptions& options) {
  command.add_flag("--deposit-only", options.deposit_only,
                   "Only sees to it that the packing is in the cache");
  command.add_flag("--new-packing", options.new_packing,
                   "Deposits the grains again, whatever the cache has");
  command
      .add_option("--packing-cache", options.packing_cache,
                  "Where deposited packings are kept (<output>/../packings)")
      ->type_name("DIR");
  command
      .add_option("--capture", options.capture,
                  "Keeps the friction problems of steps as FCLIB files in <output>/capture: "
                  "every=50 (two consecutive "
                  "ones each; steps=3: three), from=1000,to=1020")
      ->type_name("WHICH");
  command
      .add_option("--threads", options.threads,
                  "Threads of the solver (1); the results are the same to the last bit")
      ->type_name("N")
      ->check(CLI::Range(1, 256));
  command
      .add_option("--max-seconds", options.max_seconds,
                  "Wall clock after which to write a checkpoint and exit with 3")
      ->type_name("S");
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("run", "Runs a scene into a folder of results");
  auto options = std::make_shared<RunOptions>();
  auto with_page = std::make_shared<bool>(true);
  command->add_option("scene", options->scene, "A scene's name (ballast scenes) or a TOML file")
      ->required();
  command
      ->add_option("--set", options->overrides,
                   "Overrides one value of the scene: dotted.key=value, body.0.mass=2")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  command->add_option("--output", options->output, "The run's folder (results/<scene>)")
      ->type_name("DIR");
  CLI::Option* resume =
      command->add_flag("--resume", options->resume, "Continues the run found in the folder");
  CLI::Option* overwrite =
      command->add_flag("--overwrite", options->overwrite, "Replaces the run found in the folder")
          ->excludes(resume);
  command
      ->add_flag(
          "--continue", options->begin_or_resume,
          "Continues the run found in the folder or begins one; does nothing when it is finished")
      ->excludes(resume)
      ->excludes(overwrite);
  add_packing_and_limits(*command, *options);
  command->add_flag_callback(
      "--no-report", [with_page] { *with_page = false; }, "No figures and no page at the end");
  command->footer(
      "Examples:\n  ballast run vibrated_box\n"
      "  ballast run vibrated_box --set drive.frequency=10 --set solver.tolerance=1e-4 --output "
      "results/fine\n"
      "  ballast run vibrated_box --threads 2\n"
      "  ballast run vibrated_box --capture every=500 --output results/captured\n"
      "  ballast run incline --set 'gravity.direction=[0.3, 0, -1]'");
  command->callback([options, with_page, &action] {
    action = [options, with_page] {
      if (!(options->max_seconds > 0.0))
        throw UsageError("run: --max-seconds: expected a number > 0");
      if (!options->capture.empty()) check_capture(options->capture);
      const RunEnd end = run(*options);
      if (end.has_record) show_results(end, *options, *with_page);
      if (end.code != ExitCode::ok)
        std::cerr << "ballast: " << options->scene
                  << ": stopped before its end; --resume continues it" << std::endl;
      return end.code;
    };
  });
}

}  // namespace ballast
