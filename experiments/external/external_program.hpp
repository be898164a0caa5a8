#pragma once
// The two files between Ballast and a solver that is a program of its own
// (docs/manual/external.md): the request, which holds the problem, and the answer.

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "solvers/seam/solver.hpp"

namespace ballast {

/// The version of the protocol, written into both files. Another one is refused.
constexpr int external_protocol = 1;

struct ExternalRequest {
  FrictionProblem problem;
  Impulses start;                ///< rows as in the problem
  double tolerance = 0.0;        ///< on the scaled natural map, rms [m/s]; 0: not asked for
  double fclib_tolerance = 0.0;  ///< on the error that Siconos prints; 0: not asked for
  int max_iterations = 1 << 30;
  double max_seconds = 1e30;
  int id = 0;  ///< the answer repeats it
};

struct ExternalAnswer {
  /// A StopReason, or one of these two, which come without any other data.
  static constexpr int unsupported = 5, out_of_memory = 6;
  int status = static_cast<int>(StopReason::numerical_failure);
  Solved solved;  ///< of it impulses (rows as in the problem), iterations, own_residual, history
  double seconds = -1.0;  ///< of the method alone, on its own clock; below 0: not given

  /// True where something was solved: there are impulses.
  bool is_solution() const { return status < static_cast<int>(StopReason::numerical_failure); }
};

/// Writes W, q and, for known bodies, M, H. This and read_request throw Error naming the file.
void write_request(const std::filesystem::path& file, const ExternalRequest& request);
/// Reads the dynamics form where the file has it; contacts without friction have three rows.
ExternalRequest read_request(const std::filesystem::path& file);

void write_answer(const std::filesystem::path& file, const ExternalRequest& request,
                  const ExternalAnswer& answer);
/// Throws Error for an answer that is missing, incomplete, for another request, or has invalid
/// numbers. An answer without a solution (unsupported, failed, out of memory) needs no impulses.
ExternalAnswer read_answer(const std::filesystem::path& file, const ExternalRequest& request);

// Solvers that are programs of their own: `ballast compare --external name=command`.

struct ExternalCommand {
  std::string name, command;
  bool is_served = false;  ///< one process solves all problems, told line by line
  std::string folder;      ///< the folder where it starts; empty: here
};

struct ExternalLimits {
  double memory_MB = 4096.0;      ///< address space of each of its processes; 0: no limit
  double startup_seconds = 10.0;  ///< that it may take until it solves, beside the budget
};

/// Reads words "name=command" and TOML files that list them. Throws std::invalid_argument, Error.
std::vector<ExternalCommand> external_commands(const std::vector<std::string>& words);

/// Key of the command and of the files that it names: an edit of the script changes it.
std::string key_of(const ExternalCommand& command);

using MakeSolver = std::function<std::unique_ptr<Solver>()>;

/// Makes backends that, for each solve, start the program or tell the one that is running. All of
/// one maker share one program and one folder of files, in the process that asked first; these end
/// with the maker. Solved::startup_seconds is all time outside the method: starting, writing and
/// reading files. A program that gives no `seconds` is timed as a whole.
///
/// solve() throws LostProcess: the program died, or was killed because it did not answer in time;
/// UnsupportedProblem, std::bad_alloc: it says so; Error: it failed, or its answer is invalid.
MakeSolver external_solver(const ExternalCommand& command, const ExternalLimits& limits);

}  // namespace ballast
