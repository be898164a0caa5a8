#include <nlohmann/json.hpp>

#include "experiments/plans/plan_runner.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "platform/text.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace fs = std::filesystem;

std::string cluster_file(const std::string& name);  // of experiments/plans/cluster

using Json = nlohmann::ordered_json;

void write_snakemake(const Plan& plan, const fs::path& file, const PlanOptions& options,
                     const fs::path& program, const fs::path& folder_given) {
  // absolute: jobs begin elsewhere
  const auto absolute = [](const fs::path& path) { return fs::absolute(path).lexically_normal(); };
  const fs::path results = absolute(options.results), folder = absolute(folder_given);
  std::vector<PlannedRun> runs = select(plan, options.only);
  for (PlannedRun& run : runs) run.scene = absolute(find_scene(run.scene));
  Json finish{"plan", absolute(file).string(), "--output", results.string()};
  if (!options.only.empty()) finish.insert(finish.end(), {"--only", options.only});
  if (folder.string().find_first_of(" \t\n\"'{}%\\$`&;|<>()*?[]") != std::string::npos)
    throw Error(folder.string() +
                ": stands in commands for a shell and Snakemake: expected a path without blanks, "
                "quotes and brackets");
  require_own_folder(folder, {{"Snakefile", "Written by `ballast plan --snakemake`"}});
  create_folder(folder / "slurm" / "jobs");
  write_whole_file(folder / "Snakefile", cluster_file("Snakefile"));
  std::string profile = cluster_file("config.yaml");
  replace_all(profile, "@", folder.string());  // it stands for this folder
  write_whole_file(folder / "slurm" / "config.yaml", profile);
  const fs::path status = folder / "slurm" / "status.sh";
  write_whole_file(status, cluster_file("status.sh"));
  fs::permissions(status, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add);
  for (const char* name : {"runs", "packings", "logs", "snakemake"}) create_folder(results / name);
  // What the Snakefile reads: the arguments of every job, by packing and by run.
  Json packings = Json::object(), jobs = Json::object();
  for (const PlannedRun& run : runs) {
    if (!run.packing.empty() && !packings.contains(run.packing))
      packings[run.packing] = run_arguments(results, run, true);
    if (jobs.contains(run.key)) continue;
    jobs[run.key] = {
        {"name", run.name}, {"packing", run.packing}, {"arguments", run_arguments(results, run)}};
  }
  const Json all{{"program", program.string()},
                 {"results", results.string()},
                 {"finish", finish},
                 {"packings", packings},
                 {"runs", jobs}};
  write_whole_file(folder / "runs.json",
                   all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace ballast
