#pragma once
// The subcommands of the ballast program. Each adds its options to the command line; what it then
// does is an Action.

#include <functional>
#include <iosfwd>
#include <span>
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

/// One subcommand of the program.
struct Command {
  const char* name;  ///< "run"
  /// Adds the subcommand of this name to `program`; when it is the one given, parsing sets
  /// `action`.
  void (*add)(CLI::App& program, Action& action);
};
/// In the order of --help. A new command is its file and a row here.
std::span<const Command> commands();

/// The whole program: parses, acts, and turns every failure into one line "ballast: ..." on `err`
/// and an exit code.
int ballast_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

/// Carries out an action. An exception becomes its line on `err` and its exit code: UsageError and
/// UnknownSolver named on the command line 2, MissingSolver 4, everything else 1.
ExitCode perform(const Action& action, std::ostream& err);

}  // namespace ballast
