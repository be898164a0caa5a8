#include "experiments/commands/command.hpp"

namespace ballast {

// Each is defined in the file of its command; solvers, scenes and version in list_commands.cpp.
using AddCommand = void(CLI::App& program, Action& action);
AddCommand add_run_command, add_solve_command, add_compare_command, add_plan_command,
    add_paper_command, add_bench_command, add_solvers_command, add_scenes_command,
    add_check_command, add_export_command, add_version_command;

std::span<const Command> commands() {
  static constexpr Command list[] = {
      {"run", add_run_command},         {"solve", add_solve_command},
      {"compare", add_compare_command}, {"plan", add_plan_command},
      {"paper", add_paper_command},     {"bench", add_bench_command},
      {"solvers", add_solvers_command}, {"scenes", add_scenes_command},
      {"check", add_check_command},     {"export", add_export_command},
      {"version", add_version_command},
  };
  return list;
}

}  // namespace ballast
