// `ballast compare collect`: makes the collection of captured problems.

#include <iostream>
#include <memory>

#include "experiments/commands/command.hpp"
#include "experiments/compare/collection.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/interrupt.hpp"
#include "platform/text.hpp"

namespace ballast {
namespace {

struct CollectOptions {
  std::filesystem::path output = "results/collection", check;
  int largest = 2400;
};

ExitCode collect(const CollectOptions& options) {
  require_own_folder(options.output, {"runs", "packings"});
  std::vector<CollectedProblem> theirs, ours;
  if (!options.check.empty()) theirs = read_collection(options.check);
  InterruptGuard guard;
  const auto runs = collection_runs(options.largest);
  size_t done = 0;
  const auto told = [&](const CollectedRun& run) {
    std::cout << printed("%3zu/%zu  ", ++done, runs.size()) << run.name << std::endl;
  };
  const ExitCode code = make_collection(options.output, runs, told, ours);
  if (code != ExitCode::ok) return code;
  std::cout << summary_of(ours) << ": " << (options.output / "problems" / "manifest.csv").string()
            << std::endl;
  const std::vector<std::string> others = other_contents(ours, theirs);
  if (!others.empty())
    throw Error(options.check.string() + ": " + std::to_string(others.size()) +
                " problems are others than here: " + joined(others));
  return ExitCode::ok;
}

}  // namespace

Command compare_collect_command() {
  const auto options = std::make_shared<CollectOptions>();
  return {"collect",
          "Makes the collection: 72 captured problems of 60 to 10000 contacts, with a manifest",
          {{"--output DIR", &options->output, "Where it is made; the same command goes on", shown},
           {"--largest", &options->largest,
            "Grains of the largest runs: 25, 80, 200, 600, 1200, 2400 and below", shown,
            between(25, 2400)},
           {"--check MANIFEST", &options->check,
            "Another one's manifest.csv: exit code 1 where the contents differ"}},
          [options] { return collect(*options); }};
}

}  // namespace ballast
