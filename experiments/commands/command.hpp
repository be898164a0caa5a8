#pragma once
// The subcommands of the ballast program. Each adds its options to the command line; what it then
// does is an Action.

#include <functional>
#include <iosfwd>
#include <stdexcept>

#include "platform/exit_code.hpp"

namespace CLI {
class App;
}

namespace ballast {

/// What a parsed command line wants done. Throws on failure; the exception's what() is the message.
using Action = std::function<ExitCode()>;

/// The command line itself is wrong, in a way that only the command can see: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Each adds one subcommand to `program`; when that is the one given, parsing sets `action`.
void add_run_command(CLI::App& program, Action& action);
void add_solve_command(CLI::App& program, Action& action);
void add_compare_command(CLI::App& program, Action& action);
void add_bench_command(CLI::App& program, Action& action);
void add_solvers_command(CLI::App& program, Action& action);
void add_scenes_command(CLI::App& program, Action& action);
void add_export_command(CLI::App& program, Action& action);
void add_paper_command(CLI::App& program, Action& action);
void add_sweep_command(CLI::App& program, Action& action);
void add_check_command(CLI::App& program, Action& action);
void add_version_command(CLI::App& program, Action& action);

/// The whole program: parses, acts, and turns every failure into one line "ballast: ..." on `err`
/// and an exit code.
int ballast_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

/// Carries out an action. An exception becomes its line on `err` and its exit code: UsageError and
/// UnknownSolver named on the command line 2, MissingSolver 4, everything else 1.
ExitCode perform(const Action& action, std::ostream& err);

}  // namespace ballast
