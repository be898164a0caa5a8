#pragma once
// The two files between Ballast and a solver that is a program of its own
// (docs/manual/external.md): the problem with what is asked, and the answer.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solvers/seam/solver.hpp"

namespace ballast {

/// Written into both files. Another one is refused.
constexpr int external_protocol = 1;

struct ExternalRequest {
  FrictionProblem problem;
  Impulses start;                ///< rows as in the problem
  double tolerance = 0.0;        ///< on the scaled natural map, rms [m/s]; 0: not asked for
  double fclib_tolerance = 0.0;  ///< on what Siconos prints; 0: not asked for
  int max_iterations = 1 << 30;
  double max_seconds = 1e30;
  int id = 0;  ///< the answer repeats it
};

struct ExternalAnswer {
  /// How it ended: a StopReason, or one of these two, which say no more than that.
  static constexpr int unsupported = 5, out_of_memory = 6;
  int status = static_cast<int>(StopReason::numerical_failure);
  Impulses impulses;  ///< rows as in the problem
  int iterations = 0;
  double own_residual = 0.0;
  double seconds = -1.0;  ///< of the method alone, on its own clock; below 0: not said
  std::vector<HistoryPoint> history;

  /// Something was solved: there are impulses.
  bool is_solution() const { return status < static_cast<int>(StopReason::numerical_failure); }
};

/// The problem in the forms W, q and, where it has one, M, H; where only W is known, in that. Throw
/// Error naming the file.
void write_request(const std::filesystem::path& file, const ExternalRequest& request);
/// In the dynamics form where the file has it; contacts without friction have three rows.
ExternalRequest read_request(const std::filesystem::path& file);

void write_answer(const std::filesystem::path& file, const ExternalRequest& request,
                  const ExternalAnswer& answer);
/// Throws Error: no such answer, half of one, one to another request, numbers that are none. What
/// did not solve anything (unsupported, failed, out of memory) needs no impulses.
ExternalAnswer read_answer(const std::filesystem::path& file, const ExternalRequest& request);

// Solvers that are programs of their own, in any language: `ballast compare --external
// name=command`. docs/manual/external.md is what such a program must do.

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
/// std::invalid_argument, Error.
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
