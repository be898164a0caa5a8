#include "experiments/commands/command.hpp"

namespace ballast {

// Each is defined in the file of its command; solvers, scenes and version in list_commands.cpp.
Command run_command(), solve_command(), compare_command(), plan_command(), paper_command(),
    bench_command(), answer_command(), solvers_command(), scenes_command(), check_command(),
    export_command(), report_command(), view_command(), completions_command(), version_command(),
    convert_command();

std::vector<Command> commands() {
  return {run_command(),    solve_command(),   compare_command(),     plan_command(),
          paper_command(),  bench_command(),   answer_command(),      solvers_command(),
          scenes_command(), check_command(),   export_command(),      report_command(),
          view_command(),   convert_command(), completions_command(), version_command()};
}

}  // namespace ballast
