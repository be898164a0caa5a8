#pragma once
// The same plan for a cluster: no scheduler of our own, but a Snakefile and a profile for Slurm.

#include <filesystem>

#include "experiments/plans/plan.hpp"

namespace ballast {

/// Writes into `folder`:
///   Snakefile           one job per packing, then one per run; each calls the ballast program and
///                       may die and be started again
///   runs.json           what the jobs call
///   plan.toml           the plan itself: the last rule asks `ballast plan` whether everything is
///                       finished, and writes index.csv
///   slurm/config.yaml   Snakemake's options (version 7) for Slurm
///   slurm/status.sh     what became of a job
///
/// Paths are absolute: the folders of the results and of this one, and `program`, must be the same
/// on all machines. Throws SceneFileError and Error.
void write_snakemake(const Plan& plan, const std::filesystem::path& results,
                     const std::filesystem::path& program, const std::filesystem::path& folder);

}  // namespace ballast
