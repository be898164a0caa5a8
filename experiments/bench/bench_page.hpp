#pragma once
// The page of results (docs/results.md): which commands measure it, and its numbers put into it.

#include <filesystem>
#include <string>

#include "platform/error.hpp"

namespace ballast {

struct BenchAll {
  std::filesystem::path output = "results/bench_all";
  std::filesystem::path page;  ///< of somebody's own, written as results.md; none: the built-in one
  /// Numbers that are kept (numbers.csv): the page is written of them, and nothing is measured.
  std::filesystem::path rows;
  /// A shell's command of another program, whose last word is its milliseconds of a step.
  std::string beside;
};

/// Runs what has no result yet by this program, in `output`, and writes results.md, numbers.csv and
/// the figure of time against error there. The same command goes on after an interrupt. Throws
/// Error: a stage that fails.
ExitCode bench_all(const BenchAll& options);

}  // namespace ballast
