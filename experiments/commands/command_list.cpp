#include <algorithm>

#include "experiments/commands/command.hpp"

namespace ballast {

std::string help_file(const std::string& name);  // of experiments/commands/help

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

std::string help_text(std::string path) {
  std::replace(path.begin(), path.end(), ' ', '_');
  std::string text = help_file(path + ".txt");
  if (!text.empty()) text.pop_back();
  return text;
}

}  // namespace ballast
