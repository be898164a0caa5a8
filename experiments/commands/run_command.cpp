#include <CLI/CLI.hpp>

#include <iostream>
#include <memory>

#include "experiments/run/capture.hpp"
#include "experiments/commands/command.hpp"

namespace ballast {

namespace {

void check_capture(const std::string& text) {
  try {
    CaptureSettings::parse(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("run: --capture: ") + error.what());
  }
}

}  // namespace

void add_run_command(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("run", "Runs a scene into a folder of results");
  auto options = std::make_shared<RunOptions>();
  command->add_option("scene", options->scene, "A scene's name (ballast scenes) or a TOML file")->required();
  command->add_option("--set", options->overrides, "Overrides one value of the scene: dotted.key=value, body.0.mass=2")
      ->type_name("KEY=VALUE")
      ->take_all()
      ->expected(1);
  command->add_option("--output", options->output, "The run's folder (results/<scene>)")->type_name("DIR");
  CLI::Option* resume = command->add_flag("--resume", options->resume, "Continues the run found in the folder");
  CLI::Option* overwrite =
      command->add_flag("--overwrite", options->overwrite, "Replaces the run found in the folder")->excludes(resume);
  command
      ->add_flag("--continue", options->begin_or_resume,
                 "Continues the run found in the folder or begins one; does nothing when it is finished")
      ->excludes(resume)
      ->excludes(overwrite);
  command->add_flag("--deposit-only", options->deposit_only, "Only sees to it that the packing is in the cache");
  command->add_flag("--new-packing", options->new_packing, "Deposits the grains again, whatever the cache has");
  command
      ->add_option("--packing-cache", options->packing_cache,
                   "Where deposited packings are kept (<output>/../packings)")
      ->type_name("DIR");
  command
      ->add_option("--capture", options->capture,
                   "Keeps the friction problems of steps as FCLIB files in <output>/capture: every=50 (two consecutive "
                   "ones each; steps=3: three), from=1000,to=1020")
      ->type_name("WHICH");
  command
      ->add_option("--threads", options->threads, "Threads of the solver (1); the results are the same to the last bit")
      ->type_name("N")
      ->check(CLI::Range(1, 256));
  command->add_flag_callback(
      "--no-report", [options] { options->report = false; }, "No figures and no page at the end");
  command
      ->add_option("--max-seconds", options->max_seconds,
                   "Wall clock after which to write a checkpoint and exit with 3")
      ->type_name("S");
  command->footer(
      "Examples:\n  ballast run vibrated_box\n"
      "  ballast run vibrated_box --set drive.frequency=10 --set solver.tolerance=1e-4 --output results/fine\n"
      "  ballast run vibrated_box --threads 2\n"
      "  ballast run vibrated_box --capture every=500 --output results/captured\n"
      "  ballast run incline --set 'gravity.direction=[0.3, 0, -1]'");
  command->callback([options, &action] {
    action = [options] {
      if (!(options->max_seconds > 0.0)) throw UsageError("run: --max-seconds: expected a number > 0");
      if (!options->capture.empty()) check_capture(options->capture);
      const ExitCode code = run(*options);
      if (code != ExitCode::ok)
        std::cerr << "ballast: " << options->scene << ": stopped before its end; --resume continues it" << std::endl;
      return code;
    };
  });
}

}  // namespace ballast
