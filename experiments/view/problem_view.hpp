#pragma once
// A captured problem in space: where answers to it are wrong.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/view/view_data.hpp"

namespace ballast {

/// The backends that are asked, how many iterations each may take (growing), and from where they
/// begin.
struct ErrorQuestion {
  std::vector<std::string> backends = {"pgs", "auto"};
  std::vector<int> iterations = {1, 3, 10, 30, 100, 300, 1000};
  bool is_warm = false;       ///< from the captured start; else from zero
  double max_seconds = 1e30;  ///< of one solve: larger budgets have the answer that it reached
};

/// Whether the folder of the run that a captured problem is from is around it.
bool can_view_problem(const std::filesystem::path& file);

/// The bodies of the run whose capture/ holds the file, at the stored frame nearest to the
/// problem's time, with the contacts and forces of the problem, and the judge's error of every
/// contact under each backend and budget, over the problem's velocity scale. Throws Error where
/// that run is not there, UnknownSolver, MissingSolver, UnsupportedProblem.
ViewData view_of_problem(const std::filesystem::path& file, const ErrorQuestion& question);

}  // namespace ballast
