#include <CLI/CLI.hpp>

#include <iostream>
#include <new>
#include <ostream>

#include "experiments/commands/command.hpp"
#include "experiments/run/build_info.hpp"
#include "solvers/solver_list.hpp"

namespace ballast {
namespace {

constexpr const char* examples = R"(Examples:
  ballast run vibrated_box                       the paper's experiment, into results/vibrated_box
  ballast run vibrated_box --set drive.frequency=10 --set grains.seed=2 --output results/10Hz
  ballast run vibrated_box --resume              goes on where it was stopped
  ballast solve problem.hdf5 --tolerance 1e-8    a stored problem, every measure of its error
  ballast compare problems/*.hdf5 --solvers all  every backend on the same problems, with a page
  ballast plan frequencies.toml --jobs 2         many runs, several at a time, each only once
  ballast bench step vibrated_box --steps 1000   where the time of a step goes
  ballast paper fig9                             runs and draws a figure of the paper; all: a report
  ballast check myscene.toml grain.stl           what is wrong with my files?
  ballast export results/10Hz --format vtp --output last.vtp

Exit codes:
  0  done
  1  failed; one line on standard error says why (bad scene, mesh or problem, disk full,
     not converged, ...)
  2  the command line is wrong
  3  stopped by --max-seconds; a run goes on with --resume
  4  the solver was built without the library it needs)";

void print_failure(std::ostream& err, const std::string& what) {
  std::string line;
  for (const char c : what) {
    if (c == '\n' || c == '\r') {
      if (!line.empty() && line.back() != ' ') line += ' ';
    } else {
      line += c;
    }
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  err << "ballast: " << line << std::endl;
}

}  // namespace

ExitCode perform(const Action& action, std::ostream& err) {
  try {
    return action();
  } catch (const UsageError& error) {
    print_failure(err, error.what());
    return ExitCode::usage;
  } catch (const MissingSolver& error) {
    print_failure(err, error.what());
    return ExitCode::backend_missing;
  } catch (const std::bad_alloc&) {
    print_failure(err, "out of memory");
  } catch (const std::exception& error) {
    print_failure(err, error.what());
  }
  return ExitCode::failure;
}

int ballast_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App program(
      "Nonsmooth contact dynamics of polyhedral grains, and a bench of frictional-contact solvers",
      "ballast");
  program.footer(examples);
  program.set_version_flag("--version", build_line());
  Action action = []() -> ExitCode {
    throw UsageError("a subcommand is required (ballast --help)");
  };
  for (const Command& command : commands()) command.add(program, action);
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error, out, err);  // --help
    print_failure(err, std::string(error.what()) + " (ballast --help)");
    return static_cast<int>(ExitCode::usage);
  }
  // a full disk may show only when the last of the output is written
  ExitCode code = perform(action, err);
  out.flush();
  if (!out && code == ExitCode::ok) {
    print_failure(err, "standard output: cannot be written");
    code = ExitCode::failure;
  }
  return static_cast<int>(code);
}

}  // namespace ballast
