#pragma once
// What a planned run amounts to once its scene has been read.

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/plans/plan.hpp"

namespace ballast {

struct ResolvedRun {
  PlannedRun run;
  std::string key;            ///< run_key(run)
  std::string packing;        ///< packing_key of its scene; empty: it has none
  long steps = 0;             ///< of the drive
  double work = 0.0;          ///< bodies times steps: what its time is roughly proportional to
  double packing_work = 0.0;  ///< the same of the deposit, as far as that can be known beforehand
};

/// Throws SceneFileError.
ResolvedRun resolve(const PlannedRun& run);
std::vector<ResolvedRun> resolve(const Plan& plan);

/// Where things are in a folder of results.
std::filesystem::path run_folder(const std::filesystem::path& results, const ResolvedRun& run);
std::filesystem::path packing_folder(const std::filesystem::path& results);

/// Arguments of the ballast program that begin or continue the run, or see to its packing.
std::vector<std::string> run_arguments(const std::filesystem::path& results,
                                       const ResolvedRun& run);
std::vector<std::string> deposit_arguments(const std::filesystem::path& results,
                                           const ResolvedRun& run);

/// Steps that are in the log of a run that goes on, or has gone on; 0 when there is none.
long steps_in_log(const std::filesystem::path& run_folder);

}  // namespace ballast
