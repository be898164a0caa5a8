#pragma once
// A solution to measure distances from (problems/algebra/contact_error): found once, kept in a
// file, and judged like any other answer.

#include <filesystem>
#include <optional>

#include "problems/algebra/friction_problem.hpp"

namespace ballast {

struct ExactAnswer {
  static constexpr double tolerance = 1e-9;  ///< of the natural map, over the velocity scale

  Impulses impulses;
  double error = 0.0;  ///< the judge's natural map rms over the velocity scale
};

struct ExactSearch {
  double velocity_scale = 1.0;  ///< [m/s]
  double max_seconds = 10.0;    ///< wall clock, at most; 0 or less: nothing is looked for
  /// Where it is kept, by `key`; empty: nowhere. What was not found is looked for again.
  std::filesystem::path folder = {};
  std::string key = {};  ///< of problem and start
};

/// By newton_burst where the bodies are known, then by `auto`, in a child process, from `start`
/// (empty: zero). Nothing where neither of them comes to the tolerance in time. Throws Error where
/// the folder cannot be written.
std::optional<ExactAnswer> find_exact_answer(const FrictionProblem& problem, const Impulses& start,
                                             const ExactSearch& search);

}  // namespace ballast
