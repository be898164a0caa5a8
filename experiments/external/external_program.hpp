#pragma once
// Solvers that are programs of their own, in any language: `ballast compare --external
// name=command`. docs/manual/external.md is what such a program must do.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "experiments/external/external_files.hpp"

namespace ballast {

struct ExternalCommand {
  std::string name, command;
  bool is_served = false;  ///< one process for all problems, which is told them line by line
  std::string folder;      ///< where it starts; empty: here
};

struct ExternalLimits {
  double memory_MB = 4096.0;      ///< address space of each of its processes; 0: no limit
  double startup_seconds = 10.0;  ///< what it may take until it solves, beside the budget
};

/// "name=command", or the name of a TOML file with a list of them; each name once. Throws
/// std::invalid_argument, SceneFileError.
std::vector<ExternalCommand> external_commands(const std::vector<std::string>& words);

/// Key of the command and of the files that it names: another one after an edit of the script.
std::string key_of(const ExternalCommand& command);

/// Backends that start the program, or tell the one that is running, for each solve. All of one
/// maker share one program and one folder of files, in the process that asked first. They end with
/// the maker. Solved::startup_seconds is everything that the method does not take: starting,
/// writing and reading files. A program that says no `seconds` is timed as a whole.
///
/// solve() throws LostProcess: it died, or did not answer in time and was killed;
/// UnsupportedProblem and std::bad_alloc: it says so; Error: it failed, or its answer is none.
std::function<std::unique_ptr<Solver>()> external_solver(const ExternalCommand& command,
                                                         const ExternalLimits& limits);

}  // namespace ballast
