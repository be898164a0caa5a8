// `ballast compare diff`: what a change did to a comparison, with an exit code for whoever watches
// over it.

#include <algorithm>
#include <iostream>
#include <limits>
#include <map>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/compare/compare_diff.hpp"
#include "experiments/compare/stored_comparison.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

struct DiffOptions {
  std::filesystem::path before, after;
  double least = 1.1;
  bool shows_all = false;
};

/// `width`: of the longest case's name.
void print_change(const ChangedSolve& solve, int width) {
  const bool has_both = solve.before > 0.0 && solve.after > 0.0;
  const std::string ratio = has_both ? printed("%.2f", solve.after / solve.before) : "-";
  std::cout << printed("%-*s %-14s %-8g%-6s%12.4g%12.4g%8s%8.2f  %s\n", width,
                       solve.case_name.c_str(), solve.solver.c_str(), solve.tolerance,
                       name_of(solve.start), solve.before, solve.after, ratio.c_str(), solve.spread,
                       name_of(solve.change));
}

ExitCode diff(const DiffOptions& options) {
  const StoredComparison before = read_comparison(options.before),
                         after = read_comparison(options.after);
  double least = options.least;
  if (before.machine != after.machine) {
    std::cout << "other machines (" << before.machine << "; " << after.machine
              << "): times are not compared\n";
    least = std::numeric_limits<double>::infinity();
  }
  const std::vector<ChangedSolve> changes = compare_diff(before.rows, after.rows, least);
  std::map<Change, int> counts;
  int width = 34;
  for (const ChangedSolve& solve : changes)
    width = std::max(width, static_cast<int>(solve.case_name.size()));
  std::cout << printed("%-*s %-14s %-8s%-6s%12s%12s%8s%8s  %s\n", width, "case", "solver", "tol",
                       "start", "before_s", "after_s", "ratio", "spread", "change");
  for (const ChangedSolve& solve : changes) {
    ++counts[solve.change];
    if (solve.change != Change::same || options.shows_all) print_change(solve, width);
  }
  std::string summary;
  for (const auto& [change, count] : counts)
    add_to_list(summary, std::to_string(count) + " " + name_of(change));
  std::cout << before.program << " -> " << after.program << ": " << summary << std::endl;
  const auto common = changes.size() - static_cast<size_t>(counts[Change::only_before]) -
                      static_cast<size_t>(counts[Change::only_after]);
  if (common == 0) throw Error("compare diff: the two have no solve in common");
  if (counts[Change::lost] + counts[Change::slower] == 0) return ExitCode::ok;
  std::cerr << "ballast: compare diff: " << counts[Change::lost] << " solves are lost and "
            << counts[Change::slower] << " slower\n";
  return ExitCode::failure;
}

}  // namespace

Command compare_diff_command() {
  const auto options = std::make_shared<DiffOptions>();
  return {"diff",
          "Two comparisons of the same cases: what is faster, slower, lost; exit code 1 if any is",
          {{"before", &options->before, "Folder of a comparison", required},
           {"after", &options->after, "Folder of another one, of the same machine", required},
           {"--least", &options->least,
            "Factor by which a median must have changed; also by more than the repeats' spread",
            shown, at_least(1)},
           {"--all", &options->shows_all, "Show what is the same, too"}},
          [options] { return diff(*options); }};
}

}  // namespace ballast
