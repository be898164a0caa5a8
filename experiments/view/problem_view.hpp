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

/// The bodies of a captured problem with its contacts and forces, and the judge's error of every
/// contact under each backend and budget, over the problem's velocity scale. The bodies are those
/// of the run whose capture/ holds the file, at the stored frame nearest to the problem's time;
/// where no run is around the file, what the problem knows of them. Throws
/// UnknownSolver, MissingSolver, UnsupportedProblem, ProblemFileError.
ViewData view_of_problem(const std::filesystem::path& file, const ErrorQuestion& question);

}  // namespace ballast
