#pragma once
// What a folder of results says about itself: which run of which plan is where, and how far.
//
//   plans/<plan>.json   {"plan": name, "runs": [{"name", "key", "packing", "steps", "scene",
//                       "overrides": ["dotted.key=value"]}]}
//   index.csv           plan,name,key,state,steps_done,steps,seconds,error_mean,commit: one row per
//                       run of every plan

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/plans/resolved_run.hpp"

namespace ballast {

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
