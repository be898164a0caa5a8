#pragma once
// The two files between Ballast and a solver that is a program of its own
// (docs/manual/external.md): the problem with what is asked, and the answer.

#include <filesystem>
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
  Verdict verdict = Verdict::unsolved;  ///< `unsupported`, `out_of_memory`: no more than that
  StopReason reason = StopReason::numerical_failure;
  Impulses impulses;  ///< rows as in the problem
  int iterations = 0;
  double own_residual = 0.0;
  double seconds = -1.0;  ///< of the method alone, on its own clock; below 0: not said
  std::vector<HistoryPoint> history;

  /// The file's number for `reason` and `verdict`: those of StopReason, and two more.
  int status() const;
  /// False: there is no such number.
  bool set_status(int status);
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

}  // namespace ballast
