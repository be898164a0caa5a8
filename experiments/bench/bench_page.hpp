#pragma once
// The page of results (docs/results.md): which commands measure it, and its numbers put into it.

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "platform/error.hpp"

namespace ballast {

/// A command whose results the page shows. It is run so many times, by turns with the others, each
/// time into a folder of its own, "NAME/TURN".
struct BenchStage {
  std::string name;
  int turns = 1;
  std::vector<std::string> words;  ///< of this program; none: another one, BenchAll::beside
};

/// results.md, built into the program, or a file like it: a comment with a line "NAME xTURNS:
/// WORDS" for each stage, then the page. `{{NAME}}` in it stands for the stage's command,
/// `{{EXPRESSION}}` for a number:
///   STAGE: MEASUREMENT         median over the turns of what read_stage() knows
///   EXPRESSION over EXPRESSION their ratio; a plain number is an expression too
/// and `{{date}}`, `{{machine}}`, `{{commit}}` for where and when it was measured.
struct BenchPage {
  std::vector<BenchStage> stages;
  std::string text;
};

/// Throws Error: no stages, one that cannot be read.
BenchPage read_bench_page(std::string_view file);

/// A number of a stage by its name; nothing where it was not measured.
using StageNumbers =
    std::function<std::optional<double>(const std::string& stage, const std::string& name)>;

/// What the folder of a stage holds, by name: medians of a bench's measurements ("1 thread,
/// all/step"), numbers of a run's summary ("drive_seconds"), and of a comparison from cold starts
/// "auto to 0.0001, solved" [%] and "auto to 0.0001, beside the others", the geometric mean over
/// cases of its time over the fastest other backend's, both 10 us longer. Throws Error.
std::map<std::string, double> read_stage(const BenchStage& stage,
                                         const std::filesystem::path& folder);

/// Every number that stands between {{ and }}, by those words. Throws Error naming an expression
/// that cannot be read.
std::map<std::string, std::string> page_numbers(const BenchPage& page, const StageNumbers& numbers);

/// The page with numbers and commands put in; "–" for a number that there is not.
std::string filled_page(const BenchPage& page, const std::map<std::string, std::string>& numbers);

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
