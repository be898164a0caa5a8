#include "experiments/plans/snakemake.hpp"

#include <nlohmann/json.hpp>

#include "experiments/plans/resolved_run.hpp"
#include "experiments/plans/results_index.hpp"
#include "platform/atomic_file.hpp"
#include "platform/error.hpp"
#include "problems/scene/scene_file.hpp"

namespace ballast {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* snakefile =
    R"(# Written by `ballast plan --snakemake`: the runs of a plan as jobs. Snakemake 7.
#
#   snakemake -s Snakefile --profile slurm      on a cluster with Slurm, from this folder
#   snakemake -s Snakefile --cores 4            on this machine
#
# A job that dies is started again and goes on at its checkpoint; so does a run that the next call
# of snakemake finds begun.

import json, os, shlex

with open(os.path.join(workflow.basedir, "runs.json")) as file:
    PLAN = json.load(file)
RESULTS, RUNS, PACKINGS = PLAN["results"], PLAN["runs"], PLAN["packings"]

# "done" says that a job of this Snakefile found the run finished; the run itself is in runs/
DONE = os.path.join(RESULTS, "snakemake", "{key}.done")
PACKING = os.path.join(RESULTS, "packings", "packing-{packing}.bin")
LOG = os.path.join(RESULTS, "logs")

def ballast(arguments):
    return "OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 " + shlex.join([PLAN["program"]] + arguments)

def packing_of(wildcards):
    packing = RUNS[wildcards.key]["packing"]
    return ancient(PACKING.format(packing=packing)) if packing else []

localrules: finished

rule finished:
    input: expand(DONE, key=RUNS)
    params: command=ballast(PLAN["finish"])
    shell: "{params.command}"

rule deposit:
    output: PACKING
    params: command=lambda wildcards: ballast(PACKINGS[wildcards.packing])
    log: os.path.join(LOG, "packing-{packing}.log")
    shell: "{params.command} >>{log} 2>&1"

rule run:
    input: packing_of
    output: touch(DONE)
    params: command=lambda wildcards: ballast(RUNS[wildcards.key]["arguments"])
    log: os.path.join(LOG, "{key}.log")
    shell: "{params.command} >>{log} 2>&1"
)";

/// @ stands for this folder.
constexpr const char* slurm_config =
    R"(# Options of Snakemake 7 for Slurm; see `snakemake --help`. Account, partition and the
# like go into `cluster`.
cluster: >-
  sbatch --parsable --job-name=ballast-{rule} --ntasks=1 --cpus-per-task={threads}
  --mem={resources.mem_mb} --time={resources.minutes} --no-requeue
  --output=@/slurm/jobs/%j.log
cluster-status: "@/slurm/status.sh"
cluster-cancel: "scancel"
default-resources:
  - mem_mb=1000
  - minutes=1440
jobs: 200
restart-times: 5
keep-going: true
rerun-incomplete: true
rerun-triggers: mtime
latency-wait: 60
max-status-checks-per-second: 5
printshellcmds: false
)";

constexpr const char* status_script = R"(#!/bin/sh
# What became of job $1: running, success or failed. A job that Slurm has forgotten counts as
# failed: it is started again and goes on.
state=$(scontrol -o show job "$1" 2>/dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p')
[ -n "$state" ] || state=$(sacct -n -X -P -o State -j "$1" 2>/dev/null | head -n 1)
case "$state" in
  COMPLETED) echo success ;;
  PENDING|CONFIGURING|RUNNING|COMPLETING|SUSPENDED|RESIZING|REQUEUED|STAGE_OUT) echo running ;;
  *) echo failed ;;
esac
)";

/// The text with every @ replaced by the folder.
std::string with_folder(std::string text, const fs::path& folder) {
  for (size_t at = text.find('@'); at != std::string::npos;
       at = text.find('@', at + folder.string().size()))
    text.replace(at, 1, folder.string());
  return text;
}

/// What the Snakefile reads: the arguments of every job, by packing and by run.
Json jobs_json(const std::vector<ResolvedRun>& runs, const fs::path& results,
               const fs::path& program, const fs::path& folder) {
  Json packings = Json::object(), jobs = Json::object();
  for (const ResolvedRun& run : runs) {
    if (!run.packing.empty() && !packings.contains(run.packing))
      packings[run.packing] = deposit_arguments(results, run);
    if (jobs.contains(run.key)) continue;
    jobs[run.key] = {{"name", run.run.name},
                     {"packing", run.packing},
                     {"arguments", run_arguments(results, run)}};
  }
  const Json finish{"plan", (folder / "plan.toml").string(), "--output", results.string()};
  return {{"program", program.string()},
          {"results", results.string()},
          {"finish", finish},
          {"packings", packings},
          {"runs", jobs}};
}

}  // namespace

void write_snakemake(const Plan& plan, const fs::path& results_given, const fs::path& program,
                     const fs::path& folder_given) {
  const fs::path results = fs::absolute(results_given).lexically_normal(),
                 folder = fs::absolute(folder_given).lexically_normal();
  Plan absolute = plan;  // jobs begin elsewhere
  for (PlannedRun& run : absolute.runs)
    run.scene = fs::absolute(find_scene(run.scene)).lexically_normal();
  const std::vector<ResolvedRun> runs = resolve(absolute);
  const bool is_plain =
      folder.string().find_first_of(" \t\n\"'{}%\\$`&;|<>()*?[]") == std::string::npos;
  if (!is_plain)
    throw Error(folder.string() +
                ": stands in commands for a shell and Snakemake: expected a path without blanks, "
                "quotes and brackets");
  for (const char* name : {"runs", "packings", "logs", "snakemake"}) create_folder(results / name);
  create_folder(folder / "slurm" / "jobs");
  note_plan(results, plan.name, runs);
  write_plan(absolute, folder / "plan.toml");
  const Json jobs = jobs_json(runs, results, program, folder);
  write_whole_file(folder / "runs.json",
                   jobs.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
  write_whole_file(folder / "Snakefile", snakefile);
  write_whole_file(folder / "slurm" / "config.yaml", with_folder(slurm_config, folder));
  const fs::path status = folder / "slurm" / "status.sh";
  write_whole_file(status, status_script);
  fs::permissions(status, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec,
                  fs::perm_options::add);
}

}  // namespace ballast
