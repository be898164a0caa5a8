#pragma once
// What a planned run amounts to once its scene has been read, where it is in a folder of results,
// and what that folder says about itself: which run of which plan is where, and how far.
//
//   plans/<plan>.json   {"plan": name, "runs": [{"name", "key", "packing", "steps", "scene",
//                       "overrides": ["dotted.key=value"]}]}
//   index.csv           plan,name,key,state,steps_done,steps,seconds,error_mean,commit: one row per
//                       run of every plan

#include <filesystem>
#include <map>
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

/// Writes plans/<plan>.json. Throws Error.
void note_plan(const std::filesystem::path& results, const std::string& plan,
               const std::vector<ResolvedRun>& runs);

/// Writes index.csv anew from plans/*.json and the runs' folders. state: finished, failed (a key of
/// `failed`), begun, waiting; seconds: of wall clock, over all steps; error_mean: rms natural map,
/// mean over steps, in g h; commit: of the program that began the run. What isn't known yet is
/// empty. Throws Error.
void write_index(const std::filesystem::path& results,
                 const std::map<std::string, std::string>& failed);

}  // namespace ballast
